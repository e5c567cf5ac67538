"""The multigrid solver: agrees with the direct one, in few iterations on meshes of any kind, with the same bits."""

from functools import cache
from itertools import permutations

import families
import numpy as np
import pytest
from holomorph import Cancelled, conformal_structure
from solved import CLOSED, FLAT, surface_of
from thin_meshes import needles

SOLVER = 1e-8  # relative residual that a result may have


def marching_tetrahedra(field):
    """The zero level of values on a grid, each cell cut into six tetrahedra: irregular, with many slivers."""
    shape = np.array(field.shape)
    cells = np.stack(np.meshgrid(*[np.arange(n - 1) for n in shape], indexing="ij"), -1).reshape(-1, 3)
    path = np.cumsum([np.zeros((6, 3), int), *np.eye(3, dtype=int)[np.array(list(permutations(range(3)))).T]], axis=0)
    tetrahedra = np.ravel_multi_index((cells[:, None, None] + path.transpose(1, 0, 2)).reshape(-1, 3).T, shape)
    tetrahedra = tetrahedra.reshape(-1, 4)
    values = field.ravel()[tetrahedra]
    order = np.argsort(values, axis=1, kind="stable")
    tetrahedra, below = np.take_along_axis(tetrahedra, order, axis=1), (values < 0).sum(axis=1)

    def cut(which, *ends):
        return np.sort(np.stack([tetrahedra[which][:, end] for end in ends], axis=1), axis=2)

    one, two, three = below == 1, below == 2, below == 3
    triangles = np.concatenate(
        [
            cut(one, (0, 1), (0, 2), (0, 3)),
            cut(three, (0, 3), (1, 3), (2, 3)),
            cut(two, (0, 2), (0, 3), (1, 3)),
            cut(two, (0, 2), (1, 3), (1, 2)),
        ]
    )
    edges, corners = np.unique(triangles.reshape(-1, 2), axis=0, return_inverse=True)
    a, b = field.ravel()[edges].T
    ends = np.stack(np.unravel_index(edges, shape), -1)
    points = ends[:, 0] + (a / (a - b))[:, None] * (ends[:, 1] - ends[:, 0])
    return families.uniform(points, corners.reshape(-1, 3))


def double_torus(n):
    """Genus 2, by marching tetrahedra on a grid n wide; values near 0 give slivers down to 0.1 degrees."""
    x, y, z = np.meshgrid(np.linspace(-1.3, 1.3, n), np.linspace(-0.8, 0.8, n), np.linspace(-0.4, 0.4, n // 2))
    field = (x**2 * (1 - x**2) - y**2) ** 2 + 0.5 * z**2 - 0.0153
    return marching_tetrahedra(np.where(np.abs(field) < 1e-5, 1e-5, field))


def high_valence(count):
    """A torus in which one edge is cut into `count` parts, so that the vertices opposite to it have that valence."""
    mesh = families.torus(40, 30, shape="triangles")
    faces = mesh.corners.reshape(-1, 3)
    a, b, c = faces[100]
    pair = np.flatnonzero((faces == a).any(axis=1) & (faces == b).any(axis=1))
    d = next(v for v in faces[pair[pair != 100][0]] if v not in (a, b))
    t = np.linspace(0, 1, count + 1)[1:-1, None]
    points = np.concatenate([mesh.vertices, (1 - t) * mesh.vertices[a] + t * mesh.vertices[b]])
    chain = np.concatenate([[a], len(mesh.vertices) + np.arange(count - 1), [b]])
    low, high = chain[:-1], chain[1:]
    fans = [np.stack([low, high, np.full(count, c)], axis=1), np.stack([high, low, np.full(count, d)], axis=1)]
    return families.uniform(points, np.concatenate([np.delete(faces, pair, axis=0), *fans]))


def in_runs(mesh, length):
    """Vertices in the given order but for runs of `length`, which change places at random."""
    runs = np.arange(0, len(mesh.vertices), length)
    np.random.default_rng(1).shuffle(runs)
    order = np.concatenate([np.arange(first, min(first + length, len(mesh.vertices))) for first in runs])
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    return families.uniform(mesh.vertices[order], number[mesh.corners].reshape(-1, 3))


def long_torus():
    """So many vertices that the loops of an iteration have many chunks for every thread."""
    return families.torus(800, 130, shape="triangles", jitter=0.3)


LARGER = {
    "marching tetrahedra": lambda: double_torus(60),
    "high valence": lambda: high_valence(3000),
    "needles": lambda: needles(1e-6),
    "stretched": lambda: families.torus(200, 100, R=20.0, r=1.0, shape="triangles"),
    "long rows": lambda: families.torus(2000, 10, R=1.0, r=0.9, shape="triangles"),
    "many slivers": lambda: families.torus(600, 50, R=1.0, r=0.9, shape="alternating", jitter=0.4),
    "random order": lambda: families.relabelled(families.torus(200, 150, shape="triangles", jitter=0.3))[0],
    "random positions": lambda: families.uniform(
        np.random.default_rng(1).normal(size=(8000, 3)),
        families.torus(100, 80, shape="triangles").corners.reshape(-1, 3),
    ),
    "genus 5": lambda: families.block_with_holes(5, refine=6, jitter=0.2),
    # A chunk needs its neighbouring chunks; the ends of a segment, and the last segment the first, need each other.
    "long torus": long_torus,
    # A chunk needs chunks anywhere: all that follow are left for the end.
    "long torus in runs": lambda: in_runs(long_torus(), 1000),
}
MESHES = [*LARGER, *CLOSED, *FLAT]


@cache
def surface(name):
    return surface_of(LARGER[name]() if name in LARGER else (CLOSED | FLAT)[name])


@cache
def solved_by(solver, name):
    return conformal_structure(surface(name), solver=solver)


# ---- solver accuracy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MESHES)
def test_agrees_with_the_direct_solver(name):
    """Forms to what a residual of 1e-10 leaves at this size, invariants to its square."""
    direct, multigrid = solved_by("direct", name), solved_by("multigrid", name)
    forms = direct.harmonic_forms
    assert np.abs(multigrid.harmonic_forms - forms).max() < 1e-6 * np.abs(forms).max()
    assert np.abs(multigrid.period_matrix - direct.period_matrix).max() < 1e-9 * np.abs(direct.period_matrix).max()


@pytest.mark.parametrize("name", MESHES)
def test_residual_and_iterations(name):
    report = solved_by("multigrid", name).solver
    assert report.name.startswith("multigrid")
    assert report.residual <= 1e-10
    assert report.iterations <= 25


@pytest.mark.parametrize("name", ["marching tetrahedra", "many slivers", "random positions", "slivers"])
def test_weights_of_both_signs(name):
    """The input triangulation: more iterations, the same accuracy."""
    structure = solved_by("multigrid", name)
    assert structure.flip_count > 0
    assert structure.uv_solver.name.startswith("multigrid")
    assert structure.uv_solver.residual <= 1e-10
    assert structure.uv_solver.iterations <= 150


def test_the_direct_solver_takes_over():
    """Weights of 1e9 are beyond single precision; it gets the matrix put together again of what is left of it."""
    structure = conformal_structure(surface_of(needles(1e-9)), solver="multigrid")
    assert structure.solver.name.startswith("direct")
    assert structure.solver.reason.startswith("asked for; the direct solver took over: multigrid reached")
    direct = conformal_structure(surface_of(needles(1e-9)), solver="direct")
    np.testing.assert_allclose(structure.period_matrix, direct.period_matrix, rtol=SOLVER)


# ---- same bits -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2, 4, 8])
@pytest.mark.parametrize("name", ["marching tetrahedra", "stretched", "long torus", "long torus in runs"])
def test_bits_do_not_depend_on_the_threads(name, threads):
    one, other = solved_by("multigrid", name), conformal_structure(surface(name), solver="multigrid", threads=threads)
    assert one.harmonic_forms.tobytes() == other.harmonic_forms.tobytes()
    assert one.period_matrix.tobytes() == other.period_matrix.tobytes()


# ---- choice ----------------------------------------------------------------------------------------------------------


def test_a_small_mesh_is_solved_directly():
    report = conformal_structure(surface("torus knot")).solver
    assert report.name.startswith("direct")
    assert report.reason == "few unknowns: 2000 unknowns and 2 right-hand sides"


def test_a_large_mesh_is_solved_by_multigrid():
    report = conformal_structure(surface_of(families.torus(250, 100, shape="triangles"))).solver
    assert report.name.startswith("multigrid")
    assert "25000 unknowns and 2 right-hand sides" in report.reason


def test_many_forms_are_solved_directly_where_that_is_fast():
    report = conformal_structure(surface_of(families.block_with_holes(15, refine=10))).solver
    assert report.name.startswith("direct: CHOLMOD" if report.reason.startswith("many") else "multigrid")
    assert "30 right-hand sides" in report.reason


# ---- progress --------------------------------------------------------------------------------------------------------


def test_cancelling_while_multigrid_works():
    """The function is called throughout the stage, and its answer ends the work."""
    mesh = surface_of(families.torus(600, 300, shape="triangles", jitter=0.2))
    fractions = []

    def note(fraction, stage):
        if stage == "harmonic forms":
            fractions.append(fraction)

    conformal_structure(mesh, solver="multigrid", progress=note)
    assert len(fractions) > 3
    assert (np.diff(fractions) >= 0).all()
    stages = []
    for last in (1, len(fractions) // 2):

        def stop(fraction, stage):
            stages.append(stage)
            return stages.count("harmonic forms") < last  # noqa: B023

        stages.clear()
        with pytest.raises(Cancelled, match="harmonic forms"):
            conformal_structure(mesh, solver="multigrid", progress=stop)
        assert stages.count("harmonic forms") == last
