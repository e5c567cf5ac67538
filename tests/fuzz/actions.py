"""What is asked of a structure. Each may end in an error of the library; what it returns is checked."""

import holomorph
import numpy as np
import oracle
from holomorph import ProgressiveMesh, Tiler, TopologyError
from holomorph.disk import DiskMap


def first_map(structure):
    """Of the first form alone, which costs no search."""
    kind = getattr(structure, "coefficient_type", np.float64)
    count = structure.holomorphic_forms.shape[0]
    return oracle.check_map(structure, np.eye(1, count, dtype=kind)[0] if count else ())


def balanced(structure):
    coefficients = structure.balanced_coefficients()
    oracle.check_finite("coefficients", coefficients)
    oracle.check_map(structure, coefficients)


def forms(structure):
    """NaN is said of edges at a puncture alone."""
    values = structure.holomorphic_forms
    edges = structure.edges
    at_punctures = np.isin(edges, getattr(structure, "punctures", [])).any(axis=1)
    oracle.check_finite("forms", values[:, ~at_punctures])
    if len(values):
        star = structure.averaged_star(np.where(at_punctures, 0.0, values[0].real))
        oracle.check_finite("averaged_star", star)
    assert len(structure.seams) == 0 or structure.seams.max() < len(edges)


def plane(structure):
    """Maps to the disk and the sphere stay there."""
    if isinstance(structure, DiskMap):
        used = structure._component.vertex_index if structure._component is not structure.surface else slice(None)
        z = structure.disk_map()[used]
        oracle.check_finite("disk_map", z)
        assert np.abs(z).max() <= 1 + 1e-9, "the disk map leaves the disk"
    if not hasattr(structure, "sphere_map"):
        raise TopologyError("no sphere")
    points = structure.sphere_map()
    points = points[structure._component.vertex_index] if structure._component is not structure.surface else points
    oracle.check_finite("sphere_map", points)
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 1e-9, "the sphere map leaves the sphere"


def tiling(structure):
    made = structure.tile(tiles=60)
    oracle.check_finite("the uv of a tiling", made.uv)
    oracle.check_finite("residues", made.residues)
    assert not np.isnan([made.added_distortion, made.left_over, made.tiles, made.density_ratio]).any()


def odd_tilings(structure):
    """Few poles, odd lattices and directions."""
    tiler = Tiler(structure.surface, 2, boundary="free", threads=1)
    made = tiler.tile(1e4, lattice=[[1, 0.5], [0, 1e-3]], direction=(0, 0, 1), turn=0.3)
    oracle.check_finite("the uv of a tiling", made.uv)
    if len(made.poles):
        moved = tiler.with_poles_moved({0: int(made.poles[-1])})
        oracle.check_finite("the uv of a moved tiling", moved.uv)


def levels(structure):
    mesh = ProgressiveMesh(structure.surface, order="independent")
    uv = structure.uv(structure.balanced_coefficients()) if structure.surface.face_offsets[-1] < 60 else None
    if uv is None:
        return
    for level in mesh.levels_of_detail(uv, [0, 12], harmonic=len(mesh.splits) % 2 == 0, threads=1):
        oracle.check_surface(level.surface)
        oracle.check_finite("the uv of a level", level.uv)


def level_structure(structure):
    mesh = ProgressiveMesh(structure.surface)
    oracle.check_surface(mesh.restore())
    oracle.check_invariants(mesh.conformal_structure(16, threads=1))


def report(structure):
    made = holomorph.report.component_report(structure._component, structure)
    assert made["done"]


def double(structure):
    """The double is closed, of genus 2g + b - 1."""
    surface = structure._component
    doubled = holomorph.double_cover(surface)
    assert doubled.boundary_count == 0
    assert doubled.genus == 2 * surface.genus + surface.boundary_count - 1
    oracle.check_invariants(holomorph.conformal_structure(doubled, threads=1))


ACTIONS = {
    "map": first_map,
    "balanced": balanced,
    "forms": forms,
    "plane": plane,
    "tiling": tiling,
    "odd tilings": odd_tilings,
    "levels": levels,
    "level structure": level_structure,
    "report": report,
    "double": double,
}
# How often each is taken: the slow ones seldom.
SHARES = {
    "map": 0.7,
    "balanced": 0.04,
    "forms": 0.2,
    "plane": 0.3,
    "tiling": 0.01,
    "odd tilings": 0.01,
    "levels": 0.03,
    "level structure": 0.05,
    "report": 0.02,
    "double": 0.05,
}


def chosen(random):
    return [name for name, share in SHARES.items() if random.random() < share]
