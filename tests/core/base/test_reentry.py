"""The library called from its own progress functions, with the same objects: at every stage it answers as elsewhere."""

import families
import numpy as np
import pytest
from holomorph import (
    ProgressiveMesh,
    Tiler,
    automatic_map,
    automatic_maps,
    automatic_structure,
    automorphisms,
    conformal_map,
    conformal_structure,
    conformally_equivalent,
    disk_map,
    form_map,
    free_boundary_map,
    island_map,
    log_map,
    place_poles,
    rectangle_map,
)
from solved import CLOSED, surface_of


def block():
    return surface_of(CLOSED["genus 2 block"])


def torus():
    return surface_of(families.torus(14, 10))


def disk():
    return surface_of(families.hemisphere(6, 0.2))


def pants():
    return surface_of(families.punched(families.geodesic_sphere(5), 3))


def flipped():
    """Whose forms on the input's own triangles are computed when UVs are asked for."""
    return surface_of(families.torus(14, 10, shape="triangles", jitter=0.4))


def flipped_pants():
    return surface_of(families.punched(families.torus(14, 10, shape="triangles", jitter=0.4), 2))


def tiled(name):
    """A call of what a tiler can do to a tiling of its own."""

    def begin():
        tiler = Tiler(torus(), 2)
        made = tiler.tile(64)
        moves = {0: int(made.poles[0])}
        return {
            "tile": lambda progress: tiler.tile(49, progress=progress),
            "even": lambda progress: tiler.even(made, 0.5, progress=progress),
            "move": lambda progress: tiler.move_poles(made, moves, progress=progress),
        }[name]

    return begin


def of(make, call):
    """A case: what is made once, and the call on it, by its progress function."""

    def begin():
        made = make()
        return lambda progress: call(made, progress)

    return begin


def solved(surface):
    return lambda: conformal_structure(surface())


def equivalent(structure, progress):
    return conformally_equivalent(structure, structure, progress=progress)


def mapped(structure, progress):
    return conformal_map(structure, structure, progress=progress)


def carried(image, progress):
    return image.uv(np.zeros((len(torus().corner_vertices), 2)), progress=progress)


def prepared(structure, progress):
    structure.prepare_uv(progress=progress)
    return structure.uv(structure.balanced_coefficients())


CASES = {
    "structure": of(block, lambda s, p: conformal_structure(s, progress=p)),
    "multigrid": of(block, lambda s, p: conformal_structure(s, solver="multigrid", progress=p)),
    "paper": of(block, lambda s, p: conformal_structure(s, solver="paper", progress=p)),
    "paper with boundary": of(pants, lambda s, p: conformal_structure(s, solver="paper", progress=p)),
    "narrow bounds": of(torus, lambda s, p: conformal_structure(s, bounds=0.5, progress=p)),
    "boundary": of(pants, lambda s, p: conformal_structure(s, progress=p)),
    "double cover": of(pants, lambda s, p: conformal_structure(s, boundary="double_cover", progress=p)),
    "automatic structure": of(block, lambda s, p: automatic_structure(s, progress=p)),
    "log map": of(lambda: surface_of(families.geodesic_sphere(5)), lambda s, p: log_map(s, [0, 40], progress=p)),
    "forms for UVs": of(solved(flipped), prepared),
    "forms with boundary": of(solved(flipped_pants), prepared),
    "structure.tile": of(solved(torus), lambda s, p: s.tile(49, poles=2, progress=p)),
    "structure.tiler": of(solved(torus), lambda s, p: s.tiler(2, progress=p).tile(49)),
    "tiler": of(torus, lambda s, p: Tiler(s, 2, progress=p).tile(49)),
    "tiler.tile": tiled("tile"),
    "tiler.even": tiled("even"),
    "tiler.move_poles": tiled("move"),
    "poles": of(torus, lambda s, p: place_poles(s, 2, progress=p)),
    "form map": of(solved(block), lambda s, p: form_map(s.surface, s, evenness=0.5, progress=p)),
    "automatic map": of(torus, lambda s, p: automatic_map(s, progress=p)),
    "automatic maps": of(torus, lambda s, p: automatic_maps([s], progress=p)),
    "islands": of(block, lambda s, p: island_map(s, progress=p)),
    "chosen islands": of(disk, lambda s, p: automatic_map(s, main="islands", most_stretch=1.5, progress=p)),
    "disk": of(disk, lambda s, p: disk_map(s, progress=p)),
    "free boundary": of(disk, lambda s, p: free_boundary_map(s, progress=p)),
    "rectangle": of(disk, lambda s, p: rectangle_map(s, progress=p)),
    "progressive mesh": of(block, lambda s, p: ProgressiveMesh(s, progress=p).level(200)),
    "level": of(lambda: ProgressiveMesh(block()), lambda m, p: m.conformal_structure(200, progress=p)),
    "equivalence": of(solved(block), equivalent),
    "conformal map": of(solved(block), mapped),
    "carried UVs": of(lambda: mapped(conformal_structure(torus()), None), carried),
    "automorphisms": of(solved(block), lambda s, p: automorphisms(s, progress=p)),
}


def bits(value):
    """The bytes of all arrays that a result is or has."""
    if isinstance(value, np.ndarray):
        return np.ascontiguousarray(value).tobytes()
    if isinstance(value, (list, tuple)):
        return [bits(entry) for entry in value]
    if isinstance(value, (str, int, float, complex, type(None))):
        return repr(value)
    names = (
        "uv",
        "corner_uv",
        "periods",
        "poles",
        "vertices",
        "corner_vertices",
        "period_matrix",
        "harmonic_forms",
        "matrix",
    )
    return [bits(getattr(value, name)) for name in names if isinstance(getattr(value, name, None), np.ndarray)]


@pytest.mark.parametrize("name", CASES)
def test_a_call_within_itself(name):
    call, within, stages = CASES[name](), [], set()

    def ask(_, stage):
        if stage not in stages:
            stages.add(stage)
            within.append(bits(call(None)))

    outer = bits(call(ask))
    alone = bits(CASES[name]()(None))
    assert stages and within == [alone] * len(stages) and outer == alone
