"""The paper's multiresolution algorithm (§ 9) on surfaces with boundary, by the doubles of the levels (§ 8)."""

from functools import cache

import families
import numpy as np
import pytest
from conjugate_gradients import gradient_steps
from forms import edge_weights
from holomorph import (
    BoundedStructure,
    Cancelled,
    InvalidMesh,
    ProgressiveMesh,
    Surface,
    TopologyError,
    conformal_structure,
)
from repository import SHARED
from solved import BOUNDED, surface_of

LARGE = {
    "torus with 3 holes": families.punched(families.torus(90, 50, shape="triangles", jitter=0.25), 3),
    "ball with 5 holes": families.punched(families.block_with_holes(0, refine=12, jitter=0.2), 5),
}
MESHES = BOUNDED | {f"fine {name}": mesh for name, mesh in LARGE.items()}
REAL = ("hand_lowres_b1.obj", "lionstatue_g3_b1.obj", "bunny_stanford_raw.ply")

every_mesh = pytest.mark.parametrize("name", MESHES)
large_mesh = pytest.mark.parametrize("name", [f"fine {name}" for name in LARGE])


@cache
def surface(name):
    return surface_of(MESHES[name])


@cache
def solved(name):
    return conformal_structure(surface(name), solver="paper")


def change_of_basis(forms, others, tolerance):
    """The integers by which `others` are combinations of `forms`, after checking that they are."""
    change = np.linalg.lstsq(forms.T, others.T, rcond=None)[0].T
    integers = np.rint(change)
    assert np.abs(integers @ forms - others).max() < tolerance * np.abs(others).max()
    assert abs(abs(np.linalg.det(integers)) - 1) < 1e-6
    return integers


def assert_same_forms(paper, direct, tolerance=1e-4):
    """The same lattices of forms. The harmonic measures of the loops do not depend on the basis of the handles."""
    assert isinstance(paper, BoundedStructure)
    handles = 2 * paper.surface.genus
    for one, other in zip(paper.boundary_loops, direct.boundary_loops, strict=True):
        assert (one == other).all()
    change_of_basis(paper.natural_forms, direct.natural_forms, tolerance)
    change = change_of_basis(paper.dirichlet_forms, direct.dirichlet_forms, tolerance)
    loops = len(paper.pairing) - handles
    assert (change[handles:] == np.eye(loops, handles + loops, handles)).all()


# ---- the forms -------------------------------------------------------------------------------------------------------


@every_mesh
def test_agrees_with_the_direct_solver(name):
    assert_same_forms(solved(name), conformal_structure(surface(name), solver="direct"))


@every_mesh
def test_forms_are_harmonic_with_exact_classes(name):
    """Residuals are on the input triangulation; Dirichlet forms are zero along the boundary, bit for bit."""
    structure = solved(name)
    assert structure.flip_count == 0 and structure.uv_solver == structure.solver
    assert max(structure.residuals.closedness, structure.residuals.harmonicity) < 1e-7
    assert max(structure.residuals.periods, structure.residuals.pairing) < 1e-9
    pairing, handles = structure.pairing, 2 * structure.surface.genus
    assert abs(round(np.linalg.det(pairing))) == 1
    assert (pairing[:, handles:] == np.eye(len(pairing))[:, handles:]).all()
    on_boundary = np.bincount(structure.surface._native.triangle_edges.ravel()) == 1
    assert not structure.dirichlet_forms[:, on_boundary].any()


@pytest.mark.parametrize("name", REAL)
def test_real_surfaces(name):
    path = SHARED / "meshes" / name
    if not path.exists():
        pytest.skip(f"no ../shared/meshes/{name}")
    mesh = max(Surface.read(path).components, key=lambda part: len(part.triangles))
    if mesh.genus == 0 and mesh.boundary_count < 2:
        mesh = without_faces(mesh, 2)
    assert_same_forms(conformal_structure(mesh, solver="paper"), conformal_structure(mesh, solver="direct"))


def without_faces(mesh, count):
    """The surface with as many more holes, of a vertex's triangles each, far from its boundary and each other."""
    chosen = np.linspace(0, len(mesh.vertices) - 1, count + 2).astype(int)[1:-1]
    kept = mesh.triangles[~np.isin(mesh.triangles, chosen).any(axis=1)]
    (punched,) = Surface.from_polygons(mesh.vertices, kept.ravel(), 3 * np.arange(len(kept) + 1)).components
    return punched


# ---- the report ------------------------------------------------------------------------------------------------------


@every_mesh
def test_report_of_levels(name):
    report, mesh = solved(name).solver, surface(name)
    assert report.name == f"paper: scaled conjugate gradients, {len(report.levels)} levels"
    assert report.residual <= 1e-10
    faces, iterations, _ = zip(*report.levels, strict=True)
    assert list(faces) == sorted(set(faces)) and faces[-1] == len(mesh.triangles)
    assert faces[0] == len(ProgressiveMesh(mesh).base.triangles)
    assert report.iterations == iterations[-1] > 0


@large_mesh
def test_fewer_iterations_than_from_zero(name):
    """On the double of the surface itself, with the same scaling."""
    structure = solved(name)
    assert structure.solver.iterations < iterations_from_zero(structure)


def iterations_from_zero(structure):
    """Iterations for the harmonic measures of the loops: d* d(1 on loop k) as right-hand sides on the double, its inner
    vertices behind those of the surface."""
    n, edges, weights = len(structure.surface.vertices), structure.edges, edge_weights(structure)
    loop = np.full(n, -1)
    for k, vertices in enumerate(structure.boundary_loops):
        loop[vertices] = k
    dual = np.arange(n)
    dual[loop < 0] = n + np.arange((loop < 0).sum())
    indicator = np.stack([loop == k for k in range(1, len(structure.boundary_loops))]).astype(float)
    flux = weights * (indicator[:, edges[:, 1]] - indicator[:, edges[:, 0]])
    both = np.concatenate([edges, dual[edges]])
    size = dual.max() + 1
    b = np.stack(
        [np.bincount(both[:, 0], f, size) - np.bincount(both[:, 1], f, size) for f in np.hstack([flux, -flux])]
    )
    return gradient_steps(both, np.tile(weights, 2), b, scaled=True)


@large_mesh
def test_thresholds(name):
    """None of them: conjugate gradients from zero, of the same forms. M0 is always among the others."""
    forms, mesh = solved(name).natural_forms, surface(name)
    base, last = len(ProgressiveMesh(mesh).base.triangles), len(mesh.triangles)
    from_zero = conformal_structure(mesh, solver="paper", thresholds=[])
    assert [level[0] for level in from_zero.solver.levels] == [last]
    assert from_zero.solver.iterations > solved(name).solver.iterations
    with_two = conformal_structure(mesh, solver="paper", thresholds=[2000, 10**9, 1000, 1])
    faces = [level[0] for level in with_two.solver.levels]
    assert faces[0] == base and faces[-1] == last
    assert len(faces) == 4 and all(0 <= n - found < 2 for n, found in zip((1000, 2000), faces[1:3], strict=True))
    for other in (from_zero, with_two):
        assert np.abs(other.natural_forms - forms).max() < 1e-6 * np.abs(forms).max()
        assert np.abs(other.dirichlet_forms - solved(name).dirichlet_forms).max() < 1e-6
    level = ProgressiveMesh(mesh).conformal_structure(10**9, solver="paper", thresholds=[1000])
    assert len(level.solver.levels) == 3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"solver": "direct", "thresholds": []}, "thresholds need solver='paper', but solver is 'direct'"),
        ({"solver": "paper", "thresholds": [0]}, "a threshold is 0; a positive number is needed"),
        ({"solver": "paper", "thresholds": ["all"]}, "a threshold is 'all'; a positive number is needed"),
    ],
)
def test_thresholds_that_do_not_fit(options, message):
    mesh = surface("tube")
    for compute in (lambda: conformal_structure(mesh, **options), lambda: level_of(mesh, options)):
        with pytest.raises(ValueError, match=message):
            compute()


def level_of(mesh, options):
    return ProgressiveMesh(mesh).conformal_structure(10**9, **options)


# ---- levels of a progressive mesh ------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", ["paper", "direct", "multigrid"])
@pytest.mark.parametrize("order", ["quadric", "independent"])
@large_mesh
def test_levels_have_the_same_classes(name, order, solver):
    """Equal pairings, loops that are lifted, and the forms of the level itself."""
    mesh = ProgressiveMesh(surface(name), order=order)
    found = [mesh.conformal_structure(n, solver=solver) for n in (0, 1500, 10**9)]
    base = found[0]
    corners = [loop[0] for loop in base.boundary_loops]
    for structure in found:
        assert (structure.pairing == base.pairing).all()
        for start, loop in zip(corners, structure.boundary_loops, strict=True):
            assert start in loop
        assert structure.residuals.periods < 1e-9
        (alone,) = structure.surface.components
        other = conformal_structure(alone, solver="direct")
        change_of_basis(structure.natural_forms, other.natural_forms, 1e-4)
        change_of_basis(structure.dirichlet_forms, other.dirichlet_forms, 1e-4)


@pytest.mark.parametrize("name", ["one layer of quads", "torus with chords"])
def test_levels_of_meshes_with_chords(name):
    mesh = ProgressiveMesh(surface(name))
    for n in (0, 10**9):
        structure = mesh.conformal_structure(n, solver="paper")
        direct = mesh.conformal_structure(n, solver="direct")
        assert (structure.pairing == direct.pairing).all()
        assert np.abs(structure.natural_forms - direct.natural_forms).max() < 1e-4


# ---- running ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2, 4])
@large_mesh
def test_bits_do_not_depend_on_the_threads(name, threads):
    again = conformal_structure(surface(name), solver="paper", threads=threads)
    assert again.natural_forms.tobytes() == solved(name).natural_forms.tobytes()
    assert again.dirichlet_forms.tobytes() == solved(name).dirichlet_forms.tobytes()
    assert again.period_matrix.tobytes() == solved(name).period_matrix.tobytes()


def test_progress_and_cancelling():
    seen, mesh = [], surface("fine torus with 3 holes")
    conformal_structure(mesh, solver="paper", progress=lambda fraction, stage: seen.append(fraction))
    assert seen == sorted(seen) and seen[-1] == 1
    for name in ("progressive mesh", "harmonic forms"):
        with pytest.raises(Cancelled, match=name):
            conformal_structure(mesh, solver="paper", progress=lambda _, stage, name=name: stage != name)


def test_surfaces_without_forms_are_refused():
    disk = surface_of(families.hemisphere(4))
    with pytest.raises(TopologyError, match="a disk has no holomorphic forms"):
        conformal_structure(disk, solver="paper")
    for solver in ("paper", "direct"):
        with pytest.raises(TopologyError, match="genus 0 and 1 boundary; a handle, or a second boundary, is needed"):
            ProgressiveMesh(disk).conformal_structure(100, solver=solver)


def test_several_components_are_refused():
    tube = families.cylinder(12, 6)
    n = len(tube.vertices)
    twice = Surface.from_polygons(
        np.concatenate([tube.vertices, tube.vertices + 5]),
        np.concatenate([tube.corners, tube.corners + n]),
        np.concatenate([tube.offsets, tube.offsets[1:] + len(tube.corners)]),
    )
    with pytest.raises(TopologyError, match="2 connected components"):
        conformal_structure(twice, solver="paper")
    with pytest.raises(TopologyError, match="2 connected components"):
        ProgressiveMesh(twice).conformal_structure(100, solver="paper")


def test_intrinsic_surfaces_are_refused():
    flat = families.without_triangle(families.flat_torus(0.3 + 1.1j, 6), 40)
    with pytest.raises(InvalidMesh, match="edge lengths only; take one of auto, direct, multigrid"):
        conformal_structure(surface_of(flat), solver="paper")
