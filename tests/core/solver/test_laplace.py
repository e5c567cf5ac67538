"""Laplace problems with vertices fixed at 0: every solver finds the same, from one preparation for both conditions."""

from functools import cache

import families
import numpy as np
import pytest
from holomorph import Surface, _native
from repository import SHARED
from shared_data import real_file
from solved import surface_of

SOLVERS = ["direct", "multigrid"]


def sheet(n, m, holes=0, shape="triangles", jitter=0.25, seed=0):
    """n x m squares of the plane, cut into triangles, every `holes`-th one in both directions left out."""
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    kept = ~((i % holes == holes // 2) & (j % holes == holes // 2)) if holes else np.full((n, m), True)
    corner = (i * (m + 1) + j)[kept]
    quads = np.stack([corner, corner + m + 1, corner + m + 2, corner + 1], axis=1)
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(m + 1.0), indexing="ij")
    points = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    points += jitter * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    return families.uniform(points, families.cut_quads(quads, alternate=shape == "alternating"))


def tube(n, m, height=1.0):
    """n vertices around, m + 1 along."""
    mesh = families.cylinder(n, m)
    return families.uniform(mesh.vertices * [1, 1, height], families.cut_quads(mesh.corners.reshape(-1, 4)))


def pierced(mesh, count, seed=4):
    """Without some triangles, chosen at random: loops of three edges and more, some with chords."""
    faces = mesh.corners.reshape(-1, 3)
    left_out = np.random.default_rng(seed).choice(len(faces) // 8, count, replace=False) * 8
    return families.uniform(mesh.vertices, np.delete(faces, left_out, axis=0))


MESHES = {
    "triangle": lambda: sheet(1, 1, jitter=0.1),
    "strip": lambda: sheet(1, 400),
    "one row of vertices inside": lambda: sheet(2, 4000, jitter=0.2),
    "sheet": lambda: sheet(150, 100, shape="alternating"),
    "36 holes": lambda: sheet(120, 120, holes=20),
    "400 holes": lambda: sheet(200, 200, holes=10),
    "tube": lambda: tube(120, 80),
    "long tube": lambda: tube(24, 3000, height=40.0),
    "short tube": lambda: tube(3000, 12, height=0.2),
    "torus with 40 holes": lambda: pierced(families.torus(150, 100, shape="triangles", jitter=0.3), 40),
    "random order": lambda: families.relabelled(sheet(240, 160, holes=40))[0],
    "genus 3 with 25 holes": lambda: pierced(
        families.uniform(
            (block := families.block_with_holes(3, refine=6, jitter=0.2)).vertices,
            families.cut_quads(block.corners.reshape(-1, 4)),
        ),
        25,
    ),
}
REAL = [
    "beetle_59k_b11.obj",
    "big_brain_cit168_half_open.ply.gz",
    "bunny_stanford_raw.ply",
    "face_34k_b1.obj",
    "inverted_triangles_b6.obj",
    "lionstatue_g3_b1.obj",
    "plane_b27.obj",
]
every_mesh = pytest.mark.parametrize("name", [*MESHES, *REAL])


@cache
def surface(name, folder=None):
    if name in MESHES:
        return surface_of(MESHES[name]())
    return max(Surface.read(real_file(name, folder)).components, key=lambda part: len(part.triangles))


@pytest.fixture
def bounded(name, tmp_path_factory):
    if name in REAL and not (SHARED / "meshes").is_dir():
        pytest.skip("no folder ../shared/meshes")
    return surface(name, tmp_path_factory.getbasetemp() if name in REAL else None)


@cache
def boundary(surface):
    """The vertices of the boundary."""
    sides = np.sort(surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, faces = np.unique(sides, axis=0, return_counts=True)
    return np.unique(edges[faces == 1])


def right_hand_sides(surface, natural, dirichlet):
    """Columns for both conditions, alternating while there are any; and which of them fix the boundary."""
    alternating = [k % 2 for k in range(2 * min(natural, dirichlet))]
    fixes = np.array(alternating + [dirichlet > natural] * abs(natural - dirichlet), bool)
    B = np.random.default_rng(2).normal(size=(len(surface.vertices), natural + dirichlet))
    return B - ~fixes * B.mean(axis=0), fixes


class Solved:
    """Right-hand sides solved with the boundary, or other vertices, fixed."""

    def __init__(self, surface, solver, columns=(2, 2), vertices=None, threads=0):
        self.vertices = boundary(surface) if vertices is None else vertices
        self.B, self.fixes = right_hand_sides(surface, *columns)
        problem = _native.LaplaceProblem(surface._native, list(self.vertices), solver, threads)
        self.X = problem.solve(self.B, list(self.fixes))
        report = problem.report()
        self.name, self.remark, self.iterations, self.residual = (
            report.name,
            report.reason,
            report.iterations,
            report.residual,
        )
        self.edges, self.weights = problem.edges(), problem.weights()

    def residuals(self):
        """|L x - b| / |b| of every column, without the rows of fixed vertices; the weights may be large."""
        (i, j), n = self.edges.T, len(self.X)
        flow = self.weights.reshape(-1, 1) * (self.X[i] - self.X[j])
        rest = np.array([np.bincount(j, f, n) - np.bincount(i, f, n) for f in flow.T]).T + self.B
        B = self.B.copy()
        for values in (rest, B):
            values[np.ix_(self.vertices, self.fixes)] = 0
        return np.linalg.norm(rest, axis=0) / np.maximum(np.linalg.norm(B, axis=0), np.finfo(float).tiny)

    def centred(self):
        """Up to the constants, which natural right-hand sides leave open."""
        return self.X - ~self.fixes * self.X.mean(axis=0)


@cache
def solved(surface, solver):
    return Solved(surface, solver)


# ---- solver accuracy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@every_mesh
def test_equations_hold_at_the_other_vertices(name, bounded, solver):
    result = solved(bounded, solver)
    assert result.name.startswith(solver)
    assert result.residual <= 1e-9
    assert result.residuals().max() <= 1e-9


@pytest.mark.parametrize("solver", SOLVERS)
@every_mesh
def test_fixed_vertices_are_zero(name, bounded, solver):
    result = solved(bounded, solver)
    assert (result.X[np.ix_(result.vertices, result.fixes)] == 0).all()
    assert (result.X[:, ~result.fixes] != 0).any(axis=0).all()


@every_mesh
def test_solvers_agree(name, bounded):
    direct, multigrid = (solved(bounded, solver).centred() for solver in SOLVERS)
    assert np.abs(direct - multigrid).max() <= 1e-8 * np.abs(direct).max()


@every_mesh
def test_iterations(name, bounded):
    """One hierarchy serves both conditions, in as many iterations as a closed surface takes."""
    assert solved(bounded, "multigrid").iterations <= (40 if "row" in name or "strip" in name else 30)


@pytest.mark.parametrize("columns", [(0, 1), (1, 1), (0, 3), (3, 5), (7, 4)])
@pytest.mark.parametrize("solver", SOLVERS)
def test_columns_do_not_depend_on_each_other(solver, columns):
    together = Solved(surface("36 holes"), solver, columns)
    for fixes in (False, True):
        which = together.fixes == fixes
        if not which.any():
            continue
        problem = _native.LaplaceProblem(surface("36 holes")._native, list(together.vertices), solver, 0)
        alone = problem.solve(together.B[:, which], [fixes] * which.sum())
        difference = together.X[:, which] - alone
        difference -= 0 if fixes else difference.mean(axis=0)
        assert np.abs(difference).max() <= 1e-9 * np.abs(alone).max()


@pytest.mark.parametrize("part", [0, 1e-4, 0.02, 0.5, 1])
@pytest.mark.parametrize("solver", SOLVERS)
def test_any_vertices_may_be_fixed(solver, part):
    """Multigrid gives way to the direct solver where so many are fixed apart from each other that it cannot coarsen."""
    mesh = surface("torus with 40 holes")
    chosen = np.flatnonzero(np.random.default_rng(3).uniform(size=len(mesh.vertices)) < part)
    chosen = chosen if len(chosen) else np.array([17])
    result = Solved(mesh, solver, vertices=chosen)
    assert result.residuals().max() <= 1e-9
    assert (result.X[np.ix_(chosen, result.fixes)] == 0).all()
    assert result.name.startswith("direct") == (solver == "direct" or "took over" in result.remark)


# ---- same bits -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2, 4])
@pytest.mark.parametrize("name", ["sheet", "36 holes", "face_34k_b1.obj"])
@pytest.mark.parametrize("solver", SOLVERS)
def test_bits_do_not_depend_on_the_threads(solver, name, bounded, threads):
    assert Solved(bounded, solver, threads=threads).X.tobytes() == solved(bounded, solver).X.tobytes()
