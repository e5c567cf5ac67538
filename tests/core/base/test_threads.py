"""Several Python threads at once: the lock of the interpreter is released, so computations really meet."""

import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import families
import numpy as np
import pytest
from holomorph import Cancelled, InvalidMesh, Surface, Tiler, conformal_structure
from mesh_files import obj
from repository import SUPPORT
from solved import CLOSED, surface_of

# Just large enough for its loops over vertices to be shared out, which takes more than two chunks.
TORUS = families.torus(97, 85, shape="triangles", jitter=0.2)
AT_ONCE = 3


def at_once(*calls):
    """What the calls return, begun at the same moment on threads of their own."""
    start = threading.Barrier(len(calls))

    def begin(call):
        start.wait()
        return call()

    with ThreadPoolExecutor(len(calls)) as pool:
        return [future.result() for future in [pool.submit(begin, call) for call in calls]]


def bits(structure):
    arrays = (structure.period_matrix, structure.harmonic_forms, structure.uv(structure.balanced_coefficients()))
    return [array.tobytes() for array in arrays]


@pytest.mark.parametrize("solver", ["direct", "multigrid", "paper"])
def test_computations_at_once_have_the_bits_of_one_alone(solver):
    surface = surface_of(TORUS)

    def compute():
        return bits(conformal_structure(surface, solver=solver, threads=2))

    alone = compute()
    assert at_once(*[compute] * AT_ONCE) == [alone] * AT_ONCE


def test_one_structure_is_asked_by_several():
    """The forms for UVs are computed when first needed, once."""
    surface = surface_of(CLOSED["genus 2 block"])
    alone = conformal_structure(surface, threads=2)
    coefficients = alone.balanced_coefficients()
    expected = [alone.uv(coefficients).tobytes(), alone.harmonic_forms.tobytes()]
    shared = conformal_structure(surface, threads=2)
    answers = at_once(
        *[lambda: [shared.uv(coefficients).tobytes(), shared.harmonic_forms.tobytes()]] * AT_ONCE,
        lambda: [shared.prepare_uv(), shared.uv_solver] and expected,
    )
    assert answers == [expected] * (AT_ONCE + 1)


TILED = {
    "genus 2 block": CLOSED["genus 2 block"],
    "torus of quads": CLOSED["torus of quads"],
    "sphere": families.geodesic_sphere(9, jitter=0.25),
    "handle and hole": families.punctured_torus(24, 18),
}
ASKED = ((64, "square"), (100, "hex"), (150, "brick"), (200, "square"))


def tiling_bits(made):
    return [np.ascontiguousarray(array).tobytes() for array in (made.uv, made.periods, made.poles, made.residues)]


def tile_and_move(tiler, tiles, lattice):
    made = tiler.tile(tiles, lattice=lattice)
    moved = tiler.move_poles(made, {0: int(made.poles[0])})
    return tiling_bits(made) + tiling_bits(moved)


@pytest.mark.parametrize("name", TILED)
def test_one_tiler_is_asked_by_several(name):
    """What it keeps between tilings is lent to one, and made again for the others: all get the bits of one alone."""
    surface = surface_of(TILED[name])
    alone, shared = Tiler(surface, 2, threads=2), Tiler(surface, 2, threads=2)
    expected = [tile_and_move(alone, *asked) for asked in ASKED]
    assert at_once(*[partial(tile_and_move, shared, *asked) for asked in ASKED]) == expected


@pytest.mark.parametrize("name", TILED)
def test_a_tiler_is_asked_by_its_own_progress_function(name):
    """At every stage, while what it keeps is lent."""
    tiler = Tiler(surface_of(TILED[name]), 2)
    alone = [tiling_bits(tiler.tile(tiles)) for tiles in (64, 100)]
    within, stages = [], set()

    def ask(_, stage):
        if stage not in stages:
            stages.add(stage)
            within.append(tiling_bits(tiler.tile(100)))

    assert tiling_bits(tiler.tile(64, progress=ask)) == alone[0]
    assert len(within) >= 3 and all(bits == alone[1] for bits in within)


def test_cancelling_one_leaves_the_others():
    surface = surface_of(TORUS)

    def cancelled():
        with pytest.raises(Cancelled):
            conformal_structure(surface, threads=2, solver="multigrid", progress=lambda fraction, stage: fraction < 0.3)

    def done():
        return bits(conformal_structure(surface, threads=2, solver="multigrid", progress=lambda fraction, stage: True))

    alone = done()
    assert at_once(cancelled, done, cancelled, done) == [None, alone, None, alone]


def test_files_are_read_at_once(tmp_path):
    good, bad = tmp_path / "good.obj", tmp_path / "bad.obj"
    good.write_bytes(obj(TORUS))
    bad.write_bytes(b"v 0 0 zero\n")

    def refused():
        with pytest.raises(InvalidMesh, match="line 1"):
            Surface.read(bad)

    surfaces = [s for s in at_once(*[lambda: Surface.read(good), refused] * 2) if s is not None]
    assert len(surfaces) == 2
    for surface in surfaces:
        np.testing.assert_array_equal(surface.vertices, TORUS.vertices)


FORKED = """
import multiprocessing
import sys

sys.path.insert(0, sys.argv[1])
import families
from holomorph import conformal_structure
from solved import surface_of

surface = surface_of(families.torus(60, 50, shape="triangles"))


def matrix(_):
    return conformal_structure(surface, solver="direct", threads=1).period_matrix.tobytes()


before = matrix(0)  # its OpenMP threads are not in the children
with multiprocessing.get_context("fork").Pool(2) as pool:
    assert pool.map_async(matrix, range(4)).get(timeout=60) == 4 * [before]
assert matrix(0) == before
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
def test_children_by_fork_solve_as_their_parent_did():
    subprocess.run([sys.executable, "-c", FORKED, str(SUPPORT)], check=True, timeout=120)
