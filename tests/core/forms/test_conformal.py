"""Solver accuracy: identities that hold up to the residual required, on every mesh at every resolution."""

from dataclasses import replace

import families
import numpy as np
import pytest
from equivalence import distance, gram_of, symplectic_unit
from forms import (
    EdgeForms,
    determinant,
    edge_forms,
    edge_weights,
    energy_matrix,
    on_triangle_sides,
    symplectic_change,
    wedge_matrix,
)
from holomorph import conformal_structure
from solved import CLOSED, FLAT, solved, surface_of

SOLVER = 1e-8  # relative residual that a result may have
ALGEBRA = 1e-9  # dense 2g x 2g algebra on results, relative, for well-conditioned matrices

everywhere = pytest.mark.parametrize("name", [*CLOSED, *FLAT])
embedded = pytest.mark.parametrize("name", CLOSED)


def size(matrix):
    return np.abs(matrix).max()


def positive(matrix):
    """Smallest eigenvalue of the symmetric part, relative to the largest entry."""
    return np.linalg.eigvalsh((matrix + matrix.conj().T) / 2).min() / size(matrix)


# ---- forms ---------------------------------------------------------------------------------------


@everywhere
def test_certificates(name):
    residuals = solved(name).residuals
    assert 0 <= residuals.closedness < SOLVER
    assert 0 <= residuals.harmonicity < SOLVER
    assert 0 <= residuals.periods < SOLVER


@pytest.mark.parametrize("name", ["even torus", "torus knot", "genus 8 block"])
def test_harmonicity_is_what_multigrid_leaves(name):
    """By its definition: the largest |d* h| at a vertex over the largest sum of |k h| at one, in the worst form."""
    structure = conformal_structure(surface_of(CLOSED[name]), solver="multigrid")
    assert structure.flip_count == 0
    (start, end), count, found = structure.edges.T, len(structure.surface.vertices), []
    for flux in structure.harmonic_forms * edge_weights(structure):
        out = np.bincount(start, flux, count) - np.bincount(end, flux, count)
        total = np.bincount(start, abs(flux), count) + np.bincount(end, abs(flux), count)
        found.append(size(out) / size(total))
    assert structure.residuals.harmonicity == pytest.approx(max(found), rel=1e-2)
    assert max(found) > 100 * np.finfo(float).eps


@embedded
def test_forms_are_closed(name):
    structure = solved(name)
    for forms in (structure.harmonic_forms, structure.holomorphic_forms):
        assert size(on_triangle_sides(structure, forms).sum(axis=2)) < SOLVER * size(forms)


@embedded
def test_harmonic_forms_are_dual_to_the_loops(name):
    structure = solved(name)
    periods = edge_forms(structure).integrals(structure.harmonic_forms, structure.homology_basis)
    assert size(periods - np.eye(len(periods))) < SOLVER


@embedded
def test_harmonic_forms_are_the_least_of_their_classes(name):
    """d(k h) = 0 on the triangulation with the positions given: no function added lowers the energy."""
    structure = solved(name)
    weighted = structure.harmonic_forms * edge_weights(structure)
    start, end = structure.edges.T
    flux = np.zeros((len(weighted), len(structure.surface.vertices)))
    total = np.zeros_like(flux)
    for row, form in enumerate(weighted):
        flux[row] = np.bincount(start, form, flux.shape[1]) - np.bincount(end, form, flux.shape[1])
        total[row] = np.bincount(start, abs(form), flux.shape[1]) + np.bincount(end, abs(form), flux.shape[1])
    assert size(flux) < SOLVER * size(total)


@embedded
def test_wedge_matrix_is_minus_the_inverse_of_the_intersections(name):
    structure = solved(name)
    wedge = wedge_matrix(structure, structure.harmonic_forms)
    unit = wedge @ structure.intersection_matrix
    assert size(unit + np.eye(len(unit))) < SOLVER * len(unit) * max(1, size(structure.intersection_matrix))


@embedded
def test_holomorphic_periods(name):
    """1 over a_j and 0 over the other a; Omega over the b."""
    structure = solved(name)
    g = len(structure.period_matrix)
    periods = edge_forms(structure).integrals(structure.holomorphic_forms, structure.homology_basis)
    canonical = periods @ structure.canonical_basis.T
    scale = max(1, size(structure.canonical_basis)) * max(1, size(structure.period_matrix))
    assert size(canonical[:, :g] - np.eye(g)) < SOLVER * scale
    assert size(canonical[:, g:] - structure.period_matrix) < SOLVER * scale  # symmetric, so transposed or not


# ---- the Gram matrix and what follows from it ----------------------------------------------------


def canonical_gram(structure):
    """The Gram matrix in the classes dual to the canonical basis: with rows R of cycles, these are the rows of R^-T."""
    classes = np.linalg.inv(structure.canonical_basis).T
    return classes @ structure.gram_matrix @ classes.T


@everywhere
def test_gram_matrix(name):
    gram = solved(name).gram_matrix
    assert (gram == gram.T).all()
    assert positive(gram) > 0


@embedded
def test_gram_matrix_is_the_least_energy(name):
    """Intrinsic Delaunay edges give the least energy of all triangulations (Rippa 1990), the input one among them."""
    structure = solved(name)
    energy = energy_matrix(structure, structure.harmonic_forms)
    assert positive(energy - structure.gram_matrix) * size(energy - structure.gram_matrix) > -SOLVER * size(energy)


@pytest.mark.parametrize("name", ["genus 1 block", "genus 8 block", "cage", "partly reversed"])
def test_gram_matrix_on_squares_is_the_energy(name):
    """Squares are Delaunay however they are cut: nothing is flipped that matters."""
    structure = solved(name)
    energy = energy_matrix(structure, structure.harmonic_forms)
    assert size(energy - structure.gram_matrix) < SOLVER * size(energy)


@everywhere
def test_period_matrix(name):
    omega = solved(name).period_matrix
    assert size(omega - omega.T) < ALGEBRA * size(omega)
    assert np.linalg.eigvalsh(omega.imag).min() > 0


@everywhere
def test_period_matrix_is_the_symplectic_projection_of_the_gram_matrix(name):
    """C = G J, C# = C (-C^2)^(-1/2), here by eigenvalues."""
    structure = solved(name)
    J = symplectic_unit(len(structure.period_matrix))
    C = canonical_gram(structure) @ J
    values, vectors = np.linalg.eig(-C @ C)
    root = np.real(vectors @ np.diag(values**-0.5) @ np.linalg.inv(vectors))
    projected = -C @ root @ J
    assert size(projected - gram_of(structure.period_matrix)) < 1e-6 * size(projected)  # eig of a non-normal matrix


@everywhere
def test_bounds_are_those_of_the_gram_matrix(name):
    structure = solved(name)
    g = len(structure.period_matrix)
    gram = canonical_gram(structure)
    inverse = np.linalg.inv(gram[g:, g:])
    lower, upper = structure.period_bounds
    assert size(lower - inverse) < ALGEBRA * size(gram) * max(1, size(inverse))
    assert size(upper - (gram[:g, :g] - gram[:g, g:] @ inverse @ gram[g:, :g])) < ALGEBRA * size(gram) ** 2


@everywhere
def test_projected_value_lies_within_its_bounds(name):
    structure = solved(name)
    lower, upper = structure.period_bounds
    imaginary = structure.period_matrix.imag
    slack = ALGEBRA * size(upper) * size(canonical_gram(structure))
    assert np.linalg.eigvalsh(imaginary - lower).min() > -slack
    assert np.linalg.eigvalsh(upper - imaginary).min() > -slack


@embedded
def test_riemann_bilinear_relations(name):
    """Integral of theta_i ^ theta_j = 0, and (i/2) theta_i ^ conj(theta_j) = Im Omega: both are topological."""
    structure = solved(name)
    g = len(structure.period_matrix)
    theta = structure.holomorphic_forms
    parts = wedge_matrix(structure, np.concatenate([theta.real, theta.imag]))
    xx, xy, yx, yy = parts[:g, :g], parts[:g, g:], parts[g:, :g], parts[g:, g:]
    scale = SOLVER * len(structure.gram_matrix) * max(1, size(structure.period_matrix)) ** 2 * max(1, size(parts))
    assert size(xx - yy + 1j * (xy + yx)) < scale
    assert size(0.5j * (xx + yy + 1j * (yx - xy)) - structure.period_matrix.imag) < scale


@pytest.mark.parametrize("name", ["torus of two triangles", "jittered flat torus"])
def test_flat_torus_has_its_modulus_on_every_mesh(name):
    """Linear functions are represented exactly, so nothing but rounding is left."""
    structure = solved(name)
    assert distance(structure.period_matrix, np.array([[0.3 + 1.1j]])) < ALGEBRA
    lower, upper = structure.period_bounds
    assert size(upper - lower) < ALGEBRA


# ---- the same surface in another guise: the same structure ---------------------------------------


def assert_same_structure(structure, other, old_vertex=None, orientation=1):
    """The change of basis M between the two runs is found exactly by integrating one's forms over the other's loops;
    then it must carry intersections to intersections and Gram matrix to Gram matrix."""
    measured = symplectic_change(structure, other, old_vertex)
    M = np.rint(measured).astype(int)
    assert size(measured - M) < SOLVER * max(1, size(M))
    assert abs(determinant(M)) == 1
    assert (M @ structure.intersection_matrix @ M.T == orientation * other.intersection_matrix).all()
    expected = np.linalg.inv(M).T @ structure.gram_matrix @ np.linalg.inv(M)
    assert size(expected - other.gram_matrix) < SOLVER * size(expected) * max(1, size(M))


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@embedded
def test_scale_rotation_translation(name, scale):
    moved = families.moved(CLOSED[name], scale=scale)
    assert_same_structure(solved(name), conformal_structure(surface_of(moved)))


@pytest.mark.parametrize("seed", [1, 2])
@embedded
def test_relabelling(name, seed):
    mesh, old_vertex = families.relabelled(CLOSED[name], seed)
    assert_same_structure(solved(name), conformal_structure(surface_of(mesh)), old_vertex)


@embedded
def test_orientation_reversal(name):
    mirrored = conformal_structure(surface_of(families.mirrored(CLOSED[name])))
    assert_same_structure(solved(name), mirrored, orientation=-1)


@pytest.mark.parametrize("name", [name for name in CLOSED if CLOSED[name].genus <= 2])
def test_equivalent_period_matrices(name):
    """Omega of the relabelled mesh is that of the mesh, of the mirrored one its mirror image, up to Sp(2g, Z)."""
    omega = solved(name).period_matrix
    relabelled, _ = families.relabelled(CLOSED[name], seed=7)
    assert (
        distance(conformal_structure(surface_of(relabelled)).period_matrix, omega) < SOLVER * size(gram_of(omega)) ** 2
    )
    mirrored = conformal_structure(surface_of(families.mirrored(CLOSED[name]))).period_matrix
    assert distance(-mirrored.conj(), omega) < SOLVER * size(gram_of(omega)) ** 2


def test_partly_reversed_faces_change_nothing():
    """The majority's orientation is the surface's."""
    plain = conformal_structure(surface_of(families.block_with_holes(2, refine=2)))
    assert_same_structure(plain, solved("partly reversed"))


def test_isolated_vertices_change_nothing():
    mesh = families.torus(9, 7, jitter=0.2)
    points = np.insert(mesh.vertices, [0, 11], 5.0, axis=0)
    kept = np.setdiff1d(np.arange(len(points)), [0, 12])
    with_isolated = families.Mesh(points, kept[mesh.corners], mesh.offsets, mesh.topology)
    plain, other = conformal_structure(surface_of(mesh)), conformal_structure(surface_of(with_isolated))
    assert (other.edges == kept[plain.edges]).all()
    assert (other.gram_matrix == plain.gram_matrix).all()
    assert all((a == kept[b]).all() for a, b in zip(other.homology_basis, plain.homology_basis, strict=True))


def test_a_component_has_the_structure_of_the_mesh_alone():
    mesh = CLOSED["genus 2 block"]
    several = surface_of(families.united(families.cube(), mesh, families.torus(8, 6)))
    part = conformal_structure(several.components[1])
    alone = solved("genus 2 block")
    assert (part.edges == alone.edges).all()
    assert size(part.gram_matrix - alone.gram_matrix) < SOLVER * size(alone.gram_matrix)


# ---- degenerate geometry --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [2, 10, 100])
def test_vertices_that_coincide(count):
    """Faces of no area between them are handled: the forms are as good as any."""
    mesh = CLOSED["torus of triangles"]
    points = mesh.vertices.copy()
    points[50 : 50 + count] = points[50]
    surface = surface_of(replace(mesh, vertices=points))
    assert len(surface.repairs.zero_area_faces)
    assert surface.repairs.mollification > 0
    structure = conformal_structure(surface)
    assert max(vars(structure.residuals).values()) < SOLVER
    assert np.linalg.eigvalsh(structure.period_matrix.imag).min() > 0
    assert np.isfinite(structure.uv([1])).all()


@pytest.mark.parametrize("name", ["torus of triangles", "genus 2 block"])
def test_squashed_flat(name):
    """Both sides of the mesh in one plane: a doubled plane is as good a surface as any."""
    mesh = CLOSED[name]
    structure = conformal_structure(surface_of(replace(mesh, vertices=mesh.vertices * [1, 1, 1e-12])))
    assert max(vars(structure.residuals).values()) < SOLVER


def test_far_from_the_origin():
    """Positions lose digits, lengths of 1e-1 at 1e6 keep 9 of them."""
    mesh = CLOSED["genus 2 block"]
    moved = conformal_structure(surface_of(replace(mesh, vertices=mesh.vertices + 1e6)))
    M = np.rint(symplectic_change(solved("genus 2 block"), moved)).astype(int)
    expected = np.linalg.inv(M).T @ solved("genus 2 block").gram_matrix @ np.linalg.inv(M)
    assert size(expected - moved.gram_matrix) < 1e-7 * size(expected)


# ---- the paper's own star ------------------------------------------------------------------------


def test_averaged_star_is_near_the_projected_one_but_not_closed():
    """Discretisation: on a fine torus both stars of h_1 agree to the grid step; only one of them is closed."""
    structure = conformal_structure(surface_of(families.torus(96, 64, shape="triangles", jitter=0.1)))
    form = structure.harmonic_forms[0]
    gram, crossings = structure.gram_matrix, structure.intersection_matrix
    projected = (gram @ crossings @ structure.harmonic_forms)[0]  # C = -G W^-1 = G I
    averaged = structure.averaged_star(form)
    assert np.linalg.norm(averaged - projected) < 0.2 * np.linalg.norm(projected)
    open_sum = size(on_triangle_sides(structure, averaged[None]).sum(axis=2))
    assert open_sum > 1e-4 * size(averaged)
    assert size(on_triangle_sides(structure, projected[None]).sum(axis=2)) < SOLVER * size(projected)


def test_averaged_star_needs_one_value_per_edge():
    with pytest.raises(ValueError, match="form has the shape"):
        solved("even torus").averaged_star(np.zeros(3))


def test_edge_lookup_refuses_what_is_no_edge():
    with pytest.raises(AssertionError, match="no such edge"):
        EdgeForms(np.array([[0, 1], [1, 2]]), 3).index(np.array([0]), np.array([2]))
