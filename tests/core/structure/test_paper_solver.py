"""The paper's multiresolution algorithm (§ 9): exact classes, harmonic forms of the input triangulation, its report."""

import json
from functools import cache

import families
import numpy as np
import pytest
from command_runs import run
from computed_bits import assert_same_bits
from conjugate_gradients import gradient_steps
from forms import EdgeForms, edge_forms, edge_weights, on_triangle_sides
from holomorph import Cancelled, InvalidMesh, ProgressiveMesh, Surface, conformal_structure
from mesh_files import write_obj
from repository import SHARED
from solved import CLOSED, surface_of
from thin_meshes import needles, refined_at


def doubled_diagonal():
    """A torus, three quads around, in which the diagonal of one quad joins two vertices that an edge on the other side
    of the tube joins as well; together they go around it."""
    n, m = 10, 3
    i, j = np.divmod(np.arange(n * m), m)
    points = families.torus_points(2 * np.pi * (i + 0.6 * (j == 0)) / n, 2 * np.pi * j / m)

    def at(i, j):
        return i % n * m + j % m

    faces = [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for i in range(n) for j in range(m)]
    faces = [face for k, face in enumerate(faces) if k not in (2 * m + 1, 2 * m + 2)]
    a, b = at(2, 0), at(3, 1)
    faces += [[at(2, 1), b, a, at(2, 2)], [b, at(3, 2), at(3, 0), a]]
    return families.polygons(points, faces, ((1, 0),))


MESHES = CLOSED | {
    "doubled diagonal": doubled_diagonal(),
    "bumpy torus": families.torus(150, 80, shape="triangles", jitter=0.25),
    "fine genus 2 block": families.block_with_holes(2, refine=8, jitter=0.2),
    "irreducible torus": families.torus(3, 3, shape="triangles"),
    "wild weights": refined_at(families.torus(24, 12, R=1.0, r=0.3, shape="triangles"), 0, 50, 0.99999),
}
REAL = ("kitten_19k.obj", "double-torus.obj", "fertility_ngon_g4.obj", "tray_g23.stl", "rockerArm_ngon.obj")
LARGE = ("bumpy torus", "fine genus 2 block", "torus knot")

every_mesh = pytest.mark.parametrize("name", [*MESHES, *REAL])
large_mesh = pytest.mark.parametrize("name", LARGE)


@cache
def surface(name):
    if name in MESHES:
        return surface_of(MESHES[name])
    path = SHARED / "meshes" / name
    if not path.exists():
        pytest.skip(f"no ../shared/meshes/{name}")
    return Surface.read(path).components[0]


@cache
def solved(name):
    return conformal_structure(surface(name), solver="paper")


def derivative(structure, functions):
    return functions[:, structure.edges[:, 1]] - functions[:, structure.edges[:, 0]]


# ---- loops and classes, exactly -------------------------------------------------------------------------------------


@every_mesh
def test_loops_and_classes_of_the_base_are_dual(name):
    """The functions f cancel in every period, so the periods tell those of the integer classes."""
    structure = solved(name)
    n = 2 * structure.surface.genus
    assert len(structure.homology_basis) == n
    assert structure.residuals.periods < 1e-12
    assert structure.residuals.closedness < 1e-9
    intersection = structure.intersection_matrix
    assert intersection.dtype == np.int64 and (intersection == -intersection.T).all()
    canonical = structure.canonical_basis
    g = n // 2
    J = np.block([[np.zeros((g, g)), np.eye(g)], [-np.eye(g), np.zeros((g, g))]]).astype(int)
    assert (canonical @ intersection @ canonical.T == J).all()


@pytest.mark.parametrize("name", [name for name in MESHES if name != "doubled diagonal"])
def test_intersections_are_those_of_the_base_mesh(name):
    base = conformal_structure(ProgressiveMesh(surface(name)).base, solver="direct")
    assert (solved(name).intersection_matrix == base.intersection_matrix).all()


def test_a_doubled_diagonal_is_gone_around():
    """Neither classes nor loops may take the edge on the other side of the tube for the diagonal."""
    structure = solved("doubled diagonal")
    edges = structure.edges
    assert len(np.unique(edges, axis=0)) < len(edges)
    side = structure.surface._native.triangle_edges
    ends = np.stack([structure.surface.triangles, np.roll(structure.surface.triangles, -1, axis=1)], axis=-1)
    sign = np.where(ends[..., 0] == edges[side][..., 0], 1, -1)
    around = (structure.harmonic_forms[:, side] * sign).sum(axis=2)
    assert np.abs(around).max() < 1e-12
    assert max(vars(structure.residuals).values()) < 1e-9


# ---- solver accuracy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in (*MESHES, *REAL) if name != "doubled diagonal"])
def test_forms_are_harmonic_on_the_input_triangulation(name):
    """Closed, with the right periods and harmonic: there is only one such form in each class."""
    structure = solved(name)
    forms, weights = structure.harmonic_forms, edge_weights(structure)
    assert np.abs(on_triangle_sides(structure, forms).sum(axis=2)).max() < 1e-12 * max(1, np.abs(forms).max())
    flux = weights * forms
    n = len(structure.surface.vertices)
    head, tail = structure.edges[:, 1], structure.edges[:, 0]
    out = np.stack([np.bincount(head, f, n) - np.bincount(tail, f, n) for f in flux])
    size = np.stack([np.bincount(head, f, n) + np.bincount(tail, f, n) for f in np.abs(flux)])
    assert (np.linalg.norm(out, axis=1) < 1e-7 * np.linalg.norm(size, axis=1)).all()
    assert structure.flip_count == 0
    assert structure.uv_solver == structure.solver


@pytest.mark.parametrize(
    "name", ["even torus", "torus knot", "genus 8 block", "bumpy torus", "wild weights", "tray_g23.stl"]
)
def test_agrees_with_the_direct_solver(name):
    """The direct solver's forms on the input triangulation, in the classes of the paper's loops."""
    structure, direct = solved(name), conformal_structure(surface(name), solver="direct")
    if direct.flip_count:
        assert direct.uv_solver.name.startswith("direct")
    loops = edge_forms(structure).integrals(direct.harmonic_forms, structure.homology_basis)
    change = np.rint(loops)
    assert np.abs(loops - change).max() < 1e-9
    # direct h_i = sum_j change_ij h_j
    expected = np.linalg.solve(change, direct.harmonic_forms)
    assert np.abs(expected - structure.harmonic_forms).max() < 1e-4 * np.abs(expected).max()


# ---- the report ------------------------------------------------------------------------------------------------------


@every_mesh
def test_report_of_levels(name):
    report = solved(name).solver
    assert report.name == f"paper: scaled conjugate gradients, {len(report.levels)} levels"
    assert report.reason == "asked for"
    assert report.residual <= 1e-10
    faces, iterations, seconds = zip(*report.levels, strict=True)
    assert list(faces) == sorted(set(faces))
    assert faces[-1] == len(surface(name).triangles)
    assert faces[0] == len(ProgressiveMesh(surface(name)).base.triangles)
    assert report.iterations == iterations[-1] > 0
    assert all(count >= 0 for count in iterations) and all(time >= 0 for time in seconds)


def test_levels_grow_by_a_factor_of_four():
    faces = [level[0] for level in solved("bumpy torus").solver.levels]
    assert 500 <= faces[1] < 2000 and len(faces) == 4
    assert all(3.9 < fine / coarse < 4.1 for coarse, fine in zip(faces[1:], faces[2:], strict=False))


def test_a_mesh_without_levels():
    """Nothing can be collapsed: the surface is its own base mesh."""
    report = solved("irreducible torus").solver
    assert len(report.levels) == 1 and report.levels[0][0] == len(surface("irreducible torus").triangles)


def test_other_solvers_have_no_levels():
    for solver in ("auto", "direct", "multigrid"):
        assert conformal_structure(surface("even torus"), solver=solver).solver.levels == ()


def iterations_from_zero(structure, scaled):
    """Iterations of conjugate gradients for the same classes up to functions, in NumPy, to a residual of 1e-10."""
    surface = structure.surface
    n, edges, weights = len(surface.vertices), structure.edges, edge_weights(structure)
    head, tail = edges[:, 1], edges[:, 0]
    forms = structure.harmonic_forms
    integer = forms - derivative(structure, potentials(structure))
    assert np.abs(integer - np.rint(integer)).max() < 1e-6
    flux = weights * np.rint(integer)
    b = np.stack([np.bincount(tail, f, n) - np.bincount(head, f, n) for f in flux])
    return gradient_steps(edges, weights, b, scaled)


def potentials(structure):
    """Potentials of the forms along a spanning tree: what is left of a form without them is an integer class."""
    n = len(structure.surface.vertices)
    edges = EdgeForms(structure.edges, n)
    order, parent = [0], np.full(n, -1)
    neighbours = [[] for _ in range(n)]
    for a, b in structure.edges.tolist():
        neighbours[a].append(b)
        neighbours[b].append(a)
    for v in order:
        for u in neighbours[v]:
            if u and parent[u] < 0:
                parent[u] = v
                order.append(u)
    step = np.zeros((len(structure.harmonic_forms), n))
    children = np.array(order[1:])
    step[:, children] = edges.along(structure.harmonic_forms, parent[children], children)
    result = np.zeros_like(step)
    for v in children:
        result[:, v] = result[:, parent[v]] + step[:, v]
    return result


@large_mesh
def test_fewer_iterations_than_from_zero(name):
    """On the surface itself, with the same scaling."""
    assert solved(name).solver.iterations < iterations_from_zero(solved(name), scaled=True)


@pytest.mark.parametrize("name", LARGE[:2])
def test_less_work_than_plain_conjugate_gradients(name):
    """The iterations of all levels together, each by its part of the surface's faces."""
    levels = solved(name).solver.levels
    work = sum(faces * iterations for faces, iterations, _ in levels) / levels[-1][0]
    assert work < iterations_from_zero(solved(name), scaled=False)


def test_command_reports_the_levels(tmp_path):
    path = write_obj(tmp_path / "torus.obj", MESHES["torus of triangles"])
    result = run(path, "--solver", "paper")
    assert result.returncode == 0
    (part,) = json.loads(result.stdout)["components"]
    assert part["solver"]["name"].startswith("paper")
    assert [level[:2] for level in part["solver"]["levels"]] == [
        list(level[:2]) for level in solved("torus of triangles").solver.levels
    ]


@pytest.mark.parametrize(("text", "thresholds"), [("none", []), ("200", [200]), ("400,200", [200, 400])])
def test_thresholds_of_the_command(tmp_path, text, thresholds):
    path = write_obj(tmp_path / "torus.obj", MESHES["torus of triangles"])
    (part,) = json.loads(run(path, "--solver", "paper", "--thresholds", text).stdout)["components"]
    again = conformal_structure(surface("torus of triangles"), solver="paper", thresholds=thresholds)
    assert [level[:2] for level in part["solver"]["levels"]] == [list(level[:2]) for level in again.solver.levels]


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (("--thresholds", "200"), 2, "thresholds need solver='paper', but solver is 'auto'"),
        (("--solver", "paper", "--thresholds", "0"), 2, "a threshold is 0; a positive number is needed"),
        (("--solver", "paper", "--thresholds", "few"), 2, "'few' is not a list of numbers of faces such as 1000,5000"),
    ],
)
def test_thresholds_that_the_command_refuses(tmp_path, options, status, message):
    result = run(write_obj(tmp_path / "torus.obj", MESHES["torus of triangles"]), *options)
    assert result.returncode == status and message in result.stderr


# ---- levels of a progressive mesh ------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ["quadric", "independent"])
def test_levels_of_a_progressive_mesh(order):
    mesh = ProgressiveMesh(surface("bumpy torus"), order=order)
    for n_faces in (0, 3000, 10**9):
        paper = mesh.conformal_structure(n_faces, solver="paper")
        direct = mesh.conformal_structure(n_faces, solver="direct")
        assert (paper.intersection_matrix == direct.intersection_matrix).all()
        assert all((a == b).all() for a, b in zip(paper.homology_basis, direct.homology_basis, strict=True))
        expected = direct.harmonic_forms
        assert np.abs(paper.harmonic_forms - expected).max() < 1e-4 * np.abs(expected).max()
        assert paper.solver.levels[-1][0] == len(paper.surface.triangles)


# ---- running ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2, 4, 8])
@large_mesh
def test_bits_do_not_depend_on_the_threads(name, threads):
    assert_same_bits(solved(name), conformal_structure(surface(name), solver="paper", threads=threads))


def test_progress_and_cancelling():
    mesh, seen = surface_of(families.torus(500, 250, shape="triangles", jitter=0.2)), []
    conformal_structure(mesh, solver="paper", progress=lambda fraction, stage: seen.append((fraction, stage)))
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions) and fractions[-1] == 1
    for name in ("progressive mesh", "harmonic forms"):
        assert any(stage == name for _, stage in seen)
        with pytest.raises(Cancelled, match=name):
            conformal_structure(mesh, solver="paper", progress=lambda _, stage, name=name: stage != name)


# ---- refusals --------------------------------------------------------------------------------------------------------


def test_intrinsic_surfaces_are_refused():
    with pytest.raises(InvalidMesh, match="edge lengths only; take one of auto, direct, multigrid"):
        conformal_structure(surface_of(families.flat_torus(1j, 4)), solver="paper")


# ---- very thin triangles ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("width", [1e-7, 1e-8, 1e-9], ids=str)
def test_needles_are_no_reason_to_refuse(width):
    """Weights are the inverse of the width. Energies on the input's own triangles are no less than on the Delaunay
    triangulation (Rippa's theorem), and those of needles hardly count."""
    needle = surface_of(needles(width))
    structure, direct = conformal_structure(needle, solver="paper"), conformal_structure(needle, solver="direct")
    areas = [np.linalg.det(found.gram_matrix) for found in (structure, direct)]
    assert areas[1] <= areas[0] < 1.01 * areas[1]
    assert structure.certificate.holds == direct.certificate.holds


def test_levels_are_given_up_one_by_one_and_that_is_said():
    solver = conformal_structure(surface_of(needles(1e-9)), solver="paper").solver
    assert solver.name.startswith("direct: ") and not solver.levels
    tried = "from 2 coarse levels, nor from 1 coarse levels, nor from 0 coarse levels"
    assert solver.reason == f"asked for; conjugate gradients did not converge {tried}; the direct solver took over"
