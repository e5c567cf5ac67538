"""Surfaces with boundary: exact integers, identities to solver accuracy, boundaries that are straight bit for bit."""

import json
from dataclasses import replace

import families
import numpy as np
import pytest
from boundaries import boundary_edges, boundary_sides, handles_of, least_eigenvalue, signed_area, size
from equivalence import distance
from forms import determinant, edge_forms, edge_weights, energy_matrix, on_triangle_sides
from holomorph import BoundedStructure, Cancelled, TopologyError, conformal_structure
from solved import BOUNDED, BOUNDED_FLAT, solved_bounded, surface_of

SOLVER = 1e-8
ALGEBRA = 1e-9

everywhere = pytest.mark.parametrize("name", [*BOUNDED, *BOUNDED_FLAT])
embedded = pytest.mark.parametrize("name", BOUNDED)
PLANAR = [name for name, mesh in BOUNDED.items() if mesh.genus == 0]
planar = pytest.mark.parametrize("name", PLANAR)


# ---- topology, exactly ---------------------------------------------------------------------------


@embedded
def test_counts(name):
    structure, mesh = solved_bounded(name), BOUNDED[name]
    n = 2 * mesh.genus + mesh.boundary_count - 1
    assert isinstance(structure, BoundedStructure)
    assert len(structure.boundary_loops) == mesh.boundary_count
    assert len(structure.homology_basis) == n
    assert structure.pairing.shape == (n, n)
    edges = len(structure.edges)
    assert structure.natural_forms.shape == structure.dirichlet_forms.shape == (n, edges)
    assert structure.holomorphic_forms.shape == (n, edges)
    assert str(n) in structure.description


@embedded
def test_boundary_loops(name):
    """Every boundary edge once, with the hole on the left; loop 0 the longest, the others by their lowest vertex."""
    structure = solved_bounded(name)
    surface, loops = structure.surface, structure.boundary_loops
    sides = np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    directed = {tuple(side) for side in sides.tolist()}
    visited = [side for loop in loops for side in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)]
    assert len(visited) == len(set(visited)) == len(boundary_edges(structure))
    for a, b in visited:
        assert (b, a) in directed
        assert (a, b) not in directed
    points = surface.vertices
    lengths = [np.linalg.norm(points[loop] - points[np.roll(loop, -1)], axis=1).sum() for loop in loops]
    assert lengths[0] > (1 - 1e-6) * max(lengths)
    assert [loop[0] for loop in loops] == [loop.min() for loop in loops]
    assert sorted(loop[0] for loop in loops[1:]) == [loop[0] for loop in loops[1:]]


@everywhere
def test_pairing(name):
    """W = [[J_h, 0], [X, 1]] in integers, |det| 1, J_h antisymmetric."""
    structure = solved_bounded(name)
    W, handles = structure.pairing, handles_of(structure)
    assert np.issubdtype(W.dtype, np.integer)
    assert abs(determinant(W)) == 1
    assert (W[:handles, :handles] == -W[:handles, :handles].T).all()
    assert not W[:handles, handles:].any()
    assert (W[handles:, handles:] == np.eye(len(W) - handles)).all()


@embedded
def test_natural_forms_are_dual_to_the_loops(name):
    structure = solved_bounded(name)
    periods = edge_forms(structure).integrals(structure.natural_forms, structure.homology_basis)
    assert size(periods - np.eye(len(periods))) < SOLVER
    first = edge_forms(structure).integrals(structure.natural_forms, structure.boundary_loops[:1])[:, 0]
    handles = handles_of(structure)
    assert size(first + np.repeat([0, 1], [handles, len(first) - handles])) < SOLVER


# ---- forms ---------------------------------------------------------------------------------------


@everywhere
def test_certificates(name):
    for value in vars(solved_bounded(name).residuals).values():
        assert 0 <= value < SOLVER


@embedded
def test_forms_are_closed(name):
    structure = solved_bounded(name)
    for forms in (structure.natural_forms, structure.dirichlet_forms, structure.holomorphic_forms):
        assert size(on_triangle_sides(structure, forms).sum(axis=2)) < SOLVER * size(forms)


@everywhere
def test_dirichlet_forms_vanish_on_the_boundary(name):
    """Exactly, not to rounding."""
    structure = solved_bounded(name)
    if structure.surface.vertices is not None:
        assert not structure.dirichlet_forms[:, boundary_edges(structure)].any()


def flux(structure, forms):
    """d* h at every vertex, and the sum of |k h| there."""
    weighted = forms * edge_weights(structure)
    start, end = structure.edges.T
    count = len(structure.surface.vertices)
    net = np.stack([np.bincount(start, w, count) - np.bincount(end, w, count) for w in weighted])
    total = np.stack([np.bincount(start, abs(w), count) + np.bincount(end, abs(w), count) for w in weighted])
    return net, total


@embedded
def test_forms_are_the_least_of_their_classes(name):
    """On the input triangulation: natural forms at every vertex, Dirichlet forms at the inner ones."""
    structure = solved_bounded(name)
    net, total = flux(structure, structure.natural_forms)
    assert size(net) < SOLVER * size(total)
    net, total = flux(structure, structure.dirichlet_forms)
    inner = np.ones(len(structure.surface.vertices), dtype=bool)
    inner[np.concatenate(structure.boundary_loops)] = False
    assert (np.abs(net[:, inner]) < SOLVER * size(total)).all()


@embedded
def test_pairing_is_the_integral_of_the_wedge(name):
    structure = solved_bounded(name)
    a, b = (on_triangle_sides(structure, forms) for forms in (structure.natural_forms, structure.dirichlet_forms))
    wedge = (a[:, :, 0] @ b[:, :, 1].T - a[:, :, 1] @ b[:, :, 0].T) / 2
    assert size(wedge - structure.pairing) < SOLVER * max(1, size(structure.pairing))


# ---- Gram matrices, projection, bounds -----------------------------------------------------------


@embedded
def test_gram_matrices_are_the_least_energies(name):
    """The intrinsic Delaunay triangulation has the least energy of all: equal where no edge was flipped."""
    structure = solved_bounded(name)
    for gram, forms in zip(structure.gram_matrices, (structure.natural_forms, structure.dirichlet_forms), strict=True):
        energy = energy_matrix(structure, forms)
        assert least_eigenvalue(energy - gram) > -SOLVER * size(energy)
        if structure.flip_count == 0:
            assert size(energy - gram) < SOLVER * size(energy)


@everywhere
def test_projection(name):
    """C# D# = -1; the geometric mean by its defining equation X A^-1 X = B; bounds on both sides."""
    structure = solved_bounded(name)
    W, (natural, dirichlet) = structure.pairing, structure.gram_matrices
    sharp_natural, sharp_dirichlet = structure.projected_gram_matrices
    lower = W @ np.linalg.inv(dirichlet) @ W.T
    scale = size(natural) * np.linalg.cond(natural)
    assert size(sharp_natural @ np.linalg.inv(natural) @ sharp_natural - lower) < ALGEBRA * scale
    C, D = structure.star, -sharp_dirichlet @ np.linalg.inv(W)
    assert size(C @ D + np.eye(len(W))) < ALGEBRA * np.linalg.cond(natural)
    assert size(C @ W.T - sharp_natural) < ALGEBRA * scale
    assert least_eigenvalue(natural - sharp_natural) > -ALGEBRA * size(natural)
    assert least_eigenvalue(sharp_natural - lower) > -ALGEBRA * size(natural)


@everywhere
def test_period_matrix_of_the_double(name):
    omega = solved_bounded(name).period_matrix
    assert size(omega - omega.T) < ALGEBRA * size(omega)
    assert np.linalg.eigvalsh(omega.imag).min() > 0
    lower, upper = solved_bounded(name).period_bounds
    assert least_eigenvalue(omega.imag - lower) > -ALGEBRA * size(upper)
    assert least_eigenvalue(upper - omega.imag) > -ALGEBRA * size(upper)


@planar
def test_planar_period_matrix_is_the_capacity_matrix(name):
    """Omega = (i/2) Cap: the Schottky double."""
    structure = solved_bounded(name)
    capacity = structure.capacity_matrix
    assert size(structure.period_matrix - 0.5j * capacity) < ALGEBRA * size(capacity)
    assert size(structure.pairing - np.eye(len(capacity))) == 0
    lower, upper = structure.capacity_bounds
    half = np.array(structure.period_bounds)
    assert size(half - np.array([lower, upper]) / 2) < ALGEBRA * size(upper)
    assert least_eigenvalue(capacity - lower) > -ALGEBRA * size(capacity)
    assert least_eigenvalue(upper - capacity) > -ALGEBRA * size(capacity)


@planar
def test_capacities_of_conductors(name):
    """Off the diagonal negative, row sums positive: what is left is the capacity against loop 0."""
    capacity = solved_bounded(name).capacity_matrix
    assert (capacity - np.diag(np.diag(capacity)) < 1e-12).all()
    assert (capacity.sum(axis=1) > 0).all()


def glued_double(mesh):
    """Two copies, the second one reversed, that share the boundary vertices: of a mesh of triangles without chords."""
    surface = surface_of(mesh)
    loops = conformal_structure(surface).boundary_loops
    count = len(mesh.vertices)
    other = np.arange(count, 2 * count)
    shared = np.concatenate(loops)
    other[shared] = shared
    faces = mesh.corners.reshape(-1, 3)
    both = np.concatenate([faces, other[faces][:, ::-1]])
    used, corners = np.unique(both, return_inverse=True)
    points = np.concatenate([mesh.vertices, mesh.vertices])[used]
    return families.uniform(points, corners.reshape(-1, 3))


@pytest.mark.parametrize(
    "mesh",
    [families.cylinder(12, 5), families.torus(16, 12)],
    ids=["tube", "torus with a hole"],
)
def test_period_matrix_is_that_of_the_closed_double(mesh):
    """Against the closed method on two copies glued along the boundary, where no triangle has an obtuse angle."""
    if mesh.boundary_count == 0:
        mesh = families.without_faces(mesh, [5], ((1, 1),))
    mesh = families.triangles_of(mesh)
    double = conformal_structure(surface_of(glued_double(mesh)))
    structure = conformal_structure(surface_of(mesh))
    assert len(double.period_matrix) == len(structure.pairing)
    assert distance(structure.period_matrix, double.period_matrix) < 1e-4


# ---- UV maps -------------------------------------------------------------------------------------


def some_coefficients(structure, seed=4):
    return np.random.default_rng(seed).normal(size=len(structure.pairing))


@embedded
def test_boundaries_are_straight_bit_for_bit(name):
    structure = solved_bounded(name)
    for c in (some_coefficients(structure), structure.balanced_coefficients()):
        v = structure.uv(c)[:, 1]
        ends = boundary_sides(structure)
        assert (v[ends[:, 0]] == v[ends[:, 1]]).all()


@planar
def test_each_loop_has_one_height(name):
    """The height of loop k is (C#^T c)_k exactly, that of loop 0 is 0."""
    structure = solved_bounded(name)
    c = some_coefficients(structure)
    surface, v = structure.surface, structure.uv(c)[:, 1]
    heights = [np.unique(v[np.isin(surface.corner_vertices, loop)]) for loop in structure.boundary_loops]
    assert [len(height) for height in heights] == [1] * len(heights)
    assert heights[0][0] == 0
    assert size(np.concatenate(heights[1:]) - structure.star.T @ c) < 1e-14 * size(structure.star) * len(c)


@embedded
def test_steps_are_the_values_of_the_form(name):
    structure = solved_bounded(name)
    surface, c = structure.surface, some_coefficients(structure)
    uv, form = structure.uv(c) @ [1, 1j], c @ structure.holomorphic_forms
    corners = surface.triangle_corners
    start, end = surface.triangles, np.roll(surface.triangles, -1, axis=1)
    step = edge_forms(structure).along(form[None], start, end)[0]
    assert size(uv[np.roll(corners, -1, axis=1)] - uv[corners] - step) < SOLVER * size(form)


@embedded
def test_surface_cut_at_the_seams_is_a_disk(name):
    """Triangles joined across all inner edges but the seams: one piece, of Euler characteristic 1 once opened."""
    structure = solved_bounded(name)
    surface = structure.surface
    assert not np.intersect1d(structure.seams, boundary_edges(structure)).size
    edge, _ = edge_forms(structure).index(surface.triangles, np.roll(surface.triangles, -1, axis=1))
    order = np.argsort(edge.ravel(), kind="stable")
    sorted_edges = edge.ravel()[order]
    pairs = np.flatnonzero(sorted_edges[1:] == sorted_edges[:-1])
    joined = ~np.isin(sorted_edges[pairs], structure.seams)
    a, b = order[pairs[joined]], order[pairs[joined] + 1]
    count = len(surface.triangles)
    assert (families.components(count, a // 3, b // 3) == 0).all()
    vertex = surface.triangles.ravel()  # corners of triangles that stay one vertex of the opened surface

    def at(side, vertex_there):
        face, i = np.divmod(side, 3)
        return np.where(vertex[side] == vertex_there, side, 3 * face + (i + 1) % 3)

    ends = structure.edges[sorted_edges[pairs[joined]]]
    left = np.concatenate([at(a, ends[:, k]) for k in (0, 1)])
    right = np.concatenate([at(b, ends[:, k]) for k in (0, 1)])
    vertices = len(np.unique(families.components(3 * count, left, right)))
    edges = len(structure.edges) + len(structure.seams)
    assert vertices - edges + count == 1


@everywhere
def test_uv_area(name):
    """c^T G_N# c, and 1 for the balanced map."""
    structure = solved_bounded(name)
    c = some_coefficients(structure)
    expected = c @ structure.projected_gram_matrices[0] @ c
    assert abs(signed_area(structure, structure.uv(c)) - expected) < SOLVER * expected
    balanced = structure.balanced_coefficients()
    assert balanced.dtype == np.float64
    assert abs(signed_area(structure, structure.uv(balanced)) - 1) < SOLVER


@pytest.mark.parametrize("wrong", [np.zeros(2), [1j], [np.nan], 1.0, [[1.0]]])
def test_uv_needs_real_coefficients(wrong):
    with pytest.raises(ValueError, match="real numbers are needed"):
        solved_bounded("tube").uv(wrong)


def test_triangles_on_one_loop_are_counted():
    """The quad inside the U has all corners on one loop, however it is cut: two triangles without UV area."""
    structure = solved_bounded("torus with chords")
    surface, collapsed = structure.surface, structure.collapsed_triangles
    on_loop = [np.isin(surface.triangles, loop).all(axis=1) for loop in structure.boundary_loops]
    assert (collapsed == np.flatnonzero(np.any(on_loop, axis=0))).all()
    assert len(collapsed) == 2
    quality = structure.quality(structure.uv(structure.balanced_coefficients()))
    assert (np.flatnonzero(quality.collapsed) == collapsed).all()
    assert np.isfinite(quality.mean_angle)


def test_diagonals_end_inside():
    """The quads at the corners of a square have three boundary vertices: their diagonals end at the fourth."""
    for jitter in (0.0, 0.3):
        structure = conformal_structure(surface_of(families.square_minus_square(3, jitter=jitter)))
        assert len(structure.collapsed_triangles) == 0


@pytest.mark.parametrize("corners", [5, 12, 70])
def test_polygons_at_the_boundary_are_cut_towards_the_inside(corners):
    """A fan of two polygons around an inner vertex, all their other corners on the boundary of a disk: every triangle
    but the fewest possible has the inner vertex. Above 64 corners the ears are cut off one by one."""
    angle = np.pi * np.arange(2 * corners) / corners
    points = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    points = np.concatenate([points, [[0.0, 0.0, 0.0]]])
    ring, centre = np.arange(2 * corners), 2 * corners
    faces = [[*ring[: corners + 1], centre], [*ring[corners:], 0, centre]]
    surface = surface_of(families.polygons(points, faces, ((0, 1),)))
    assert (surface.triangles == centre).any(axis=1).all()


# ---- the same surface in another guise -----------------------------------------------------------


def changes(structure, other, vertex=None, sign=1):
    """Integer P, Q with h'_N = P h_N and h'_D = Q h_D: from the loops of `other`, and from both pairings
    W' = sign P W Q^T. `vertex` gives the vertex of `structure` for each vertex of `other`."""
    loops = [loop if vertex is None else vertex[loop] for loop in other.homology_basis]
    M = np.rint(edge_forms(structure).integrals(structure.natural_forms, loops).T)
    P = np.linalg.inv(M).T
    Q = (sign * np.linalg.inv(P @ structure.pairing) @ other.pairing).T
    return np.rint(P), np.rint(Q)


def assert_same(structure, other, P, Q, tolerance):
    for change, gram, moved in zip(
        (P, Q), structure.projected_gram_matrices, other.projected_gram_matrices, strict=True
    ):
        assert abs(abs(np.linalg.det(change)) - 1) < 1e-6
        assert size(change @ gram @ change.T - moved) < tolerance * size(moved)


@embedded
def test_relabelling(name):
    structure = solved_bounded(name)
    mesh, old = families.relabelled(BOUNDED[name])
    other = conformal_structure(surface_of(mesh))
    assert_same(structure, other, *changes(structure, other, old), 1e-6)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@embedded
def test_scale_and_motion(name, scale):
    structure = solved_bounded(name)
    other = conformal_structure(surface_of(families.moved(BOUNDED[name], scale)))
    assert_same(structure, other, *changes(structure, other), 1e-6)


@pytest.mark.parametrize("name", ["tube", "torus of triangles with 3 holes", "genus 2 with 5 holes"])
def test_reversal(name):
    """The mirror image: the same Gram matrices, W the other way round."""
    structure = solved_bounded(name)
    other = conformal_structure(surface_of(families.mirrored(BOUNDED[name])))
    assert_same(structure, other, *changes(structure, other, sign=-1), 1e-6)


@pytest.mark.parametrize("name", ["genus 2 with 1 hole", "ball with 11 holes", "torus with chords"])
def test_solvers_agree(name):
    direct = conformal_structure(surface_of(BOUNDED[name]), solver="direct")
    multigrid = conformal_structure(surface_of(BOUNDED[name]), solver="multigrid")
    assert size(direct.natural_forms - multigrid.natural_forms) < SOLVER * size(direct.natural_forms)
    assert size(direct.dirichlet_forms - multigrid.dirichlet_forms) < SOLVER * size(direct.dirichlet_forms)
    assert not multigrid.dirichlet_forms[:, boundary_edges(multigrid)].any()


def test_same_bits_at_any_number_of_threads():
    surface = surface_of(BOUNDED["genus 2 with 5 holes"])
    one, three = (conformal_structure(surface, threads=threads) for threads in (1, 3))
    assert (one.period_matrix == three.period_matrix).all()
    assert (one.balanced_coefficients() == three.balanced_coefficients()).all()
    c = some_coefficients(one)
    assert (one.uv(c) == three.uv(c)).all()


def test_progress_rises_from_0_to_1_and_cancels_at_every_stage():
    surface = surface_of(families.punched(families.torus(150, 100, shape="triangles"), 2))
    seen = []
    conformal_structure(surface, progress=lambda fraction, stage: seen.append((fraction, stage)))
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0, 1)
    stages = dict.fromkeys(stage for _, stage in seen)
    assert len(stages) >= 6
    for wanted in stages:
        with pytest.raises(Cancelled):
            conformal_structure(surface, progress=lambda fraction, stage, wanted=wanted: stage != wanted)


def test_isolated_vertices_are_ignored():
    mesh = BOUNDED["ball with 5 holes"]
    padded = replace(
        mesh,
        vertices=np.concatenate([[[9.0, 9.0, 9.0]], mesh.vertices]),
        corners=mesh.corners + 1,
    )
    structure, other = solved_bounded("ball with 5 holes"), conformal_structure(surface_of(padded))
    assert (other.capacity_matrix == structure.capacity_matrix).all()
    assert all((a + 1 == b).all() for a, b in zip(structure.boundary_loops, other.boundary_loops, strict=True))
    assert (other.edges == structure.edges + 1).all()


# ---- what belongs to some surfaces only ----------------------------------------------------------


def test_modulus_belongs_to_annuli():
    structure = solved_bounded("ball with 2 holes")
    low, high = structure.modulus_bounds
    assert low < structure.modulus < high
    assert abs(structure.modulus * structure.capacity_matrix[0, 0] - 1) < ALGEBRA
    for name in ("ball with 5 holes", "torus with chords"):
        with pytest.raises(TopologyError, match=r"genus \d and \d+ boundar"):
            _ = solved_bounded(name).modulus


def test_capacities_belong_to_planar_surfaces():
    for name in ("punctured torus", "genus 2 with 5 holes"):
        with pytest.raises(TopologyError, match="planar"):
            _ = solved_bounded(name).capacity_matrix
        with pytest.raises(TopologyError, match="planar"):
            _ = solved_bounded(name).capacity_bounds


def test_invariants_are_plain_data():
    for name, keys in (
        ("tube", {"period_matrix", "capacity_matrix", "capacity_bounds", "modulus", "modulus_bounds"}),
        ("ball with 5 holes", {"period_matrix", "capacity_matrix", "capacity_bounds"}),
        ("punctured torus", {"period_matrix"}),
    ):
        values = json.loads(json.dumps(solved_bounded(name).invariants(), allow_nan=False))
        assert keys <= set(values)


def test_double_of_a_torus_with_a_hole_has_the_reflection():
    """The double of a surface with boundary is its own mirror image: -conj(Omega) is equivalent to Omega."""
    omega = solved_bounded("punctured torus").period_matrix
    assert distance(omega, -omega.conj()) < 1e-8 * size(omega)
