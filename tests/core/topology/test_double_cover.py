"""The double cover as a surface, and the forms found on it: the reference for those found on the surface itself."""

import families
import numpy as np
import pytest
from equivalence import distance
from holomorph import Surface, TopologyError, conformal_structure, double_cover, symmetrised
from shared_data import REAL, real_file
from solved import BOUNDED, BOUNDED_FLAT, solved_bounded, surface_of

SAME = 1e-10  # of the largest entry: both ways solve the same equations
everywhere = pytest.mark.parametrize("name", [*BOUNDED, *BOUNDED_FLAT])
embedded = pytest.mark.parametrize("name", BOUNDED)


def size(matrix):
    return np.abs(matrix).max()


# ---- the surface ---------------------------------------------------------------------------------


@everywhere
def test_double_is_closed_of_genus_n(name):
    surface = solved_bounded(name).surface
    double = double_cover(surface)
    assert double.boundary_count == 0
    assert double.genus == 2 * surface.genus + surface.boundary_count - 1
    assert len(double.triangles) == 2 * len(surface.triangles)
    assert (double.triangles[: len(surface.triangles)] == surface.triangles).all()


@embedded
def test_dual_vertices(name):
    """An involution that keeps the boundary and nothing else; it takes each triangle to the one over it, reversed."""
    structure = solved_bounded(name)
    double = double_cover(structure.surface)
    dual = double.dual_vertex
    assert (dual[dual] == np.arange(len(dual))).all()
    fixed = np.flatnonzero(dual == np.arange(len(dual)))
    assert (fixed == np.sort(np.concatenate(structure.boundary_loops))).all()
    first, second = np.split(double.triangles, 2)
    assert (dual[first][:, [0, 2, 1]] == second).all()


def test_double_of_a_closed_surface_is_refused():
    with pytest.raises(TopologyError, match="no boundary"):
        double_cover(surface_of(families.torus(6, 5)))


def test_surfaces_have_no_dual_vertices():
    assert surface_of(families.torus(6, 5)).dual_vertex is None


@pytest.mark.parametrize("name", ["tube", "punctured torus", "square minus square"])
def test_closed_structure_of_the_double(name):
    """The closed method on the double, which flips other edges: the same period matrix up to Sp(2n, Z) and the mesh."""
    structure = solved_bounded(name)
    double = conformal_structure(double_cover(structure.surface))
    assert distance(structure.period_matrix, double.period_matrix) < 1e-3 * size(structure.period_matrix)


# ---- duality ---------------------------------------------------------------------------------------


def combined(forms, basis):
    """`forms` less the combinations of `basis` that come nearest, over the forms."""
    change = np.linalg.lstsq(basis.T, forms.T, rcond=None)[0].T
    return size(forms - change @ basis) / size(forms)


@everywhere
def test_symmetric_parts_are_the_natural_forms(name):
    """Eq. 12: of all harmonic forms of the double; the antisymmetric parts are the Dirichlet forms."""
    structure = solved_bounded(name)
    double = double_cover(structure.surface)
    forms = conformal_structure(double).harmonic_forms
    symmetric = symmetrised(double, forms)
    assert (symmetrised(double, symmetric) == symmetric).all()  # Eq. 11
    assert size(symmetrised(double, forms - symmetric)) < SAME * size(forms)
    n, edges = len(structure.pairing), len(structure.edges)
    assert np.linalg.matrix_rank(symmetric, tol=1e-6 * size(symmetric)) == n
    assert combined(symmetric[:, :edges], structure.natural_forms) < 1e-4
    assert combined((forms - symmetric)[:, :edges], structure.dirichlet_forms) < 1e-4


def test_symmetric_part_of_an_exact_form():
    """df becomes d of (f(v) + f(v*)) / 2."""
    double = double_cover(solved_bounded("torus with chords").surface)
    edges, dual = double._native.edges, double.dual_vertex
    f = np.random.default_rng(0).normal(size=len(dual))

    def d(values):
        return values[edges[:, 1]] - values[edges[:, 0]]

    assert size(symmetrised(double, d(f)) - d((f + f[dual]) / 2)) < 1e-12


def test_symmetrised_refuses_other_surfaces_and_forms():
    surface = surface_of(families.cylinder(8, 2))
    with pytest.raises(TopologyError, match="not a double_cover"):
        symmetrised(surface, np.zeros(len(surface._native.edges)))
    with pytest.raises(TypeError, match="double is of type list"):
        symmetrised([], [0.0])
    for forms in (np.zeros(3), 1.0):
        with pytest.raises(ValueError, match="forms has the shape"):
            symmetrised(double_cover(surface), forms)


# ---- forms by way of the double ------------------------------------------------------------------


def assert_same(fast, reference):
    for mine, theirs in (
        (fast.natural_forms, reference.natural_forms),
        (fast.dirichlet_forms, reference.dirichlet_forms),
        (fast.holomorphic_forms, reference.holomorphic_forms),
        (fast.period_matrix, reference.period_matrix),
        *zip(fast.projected_gram_matrices, reference.projected_gram_matrices, strict=True),
        *zip(fast.gram_matrices, reference.gram_matrices, strict=True),
    ):
        assert size(mine - theirs) < SAME * size(theirs)
    assert (fast.pairing == reference.pairing).all()


@everywhere
def test_forms_are_those_of_the_double_cover(name):
    reference = conformal_structure(surface_of((BOUNDED | BOUNDED_FLAT)[name]), boundary="double_cover")
    assert_same(solved_bounded(name), reference)
    assert max(vars(reference.residuals).values()) < 1e-8


@pytest.mark.skipif(not REAL, reason="no folder ../shared/meshes")
@pytest.mark.parametrize(
    "name", ["beetle_59k_b11.obj", "plane_b27.obj", "lionstatue_g3_b1.obj", "bunny_stanford_raw.ply", "teapot_bff.obj"]
)
def test_real_forms_are_those_of_the_double_cover(name, tmp_path):
    """Two of them with chords."""
    parts = Surface.read(real_file(name, tmp_path)).components
    part = next(part for part in parts if part.boundary_count and 2 * part.genus + part.boundary_count > 1)
    assert_same(conformal_structure(part), conformal_structure(part, boundary="double_cover"))


@pytest.mark.parametrize("count", [3, 4, 7, 20, 150])
def test_ribbons_without_inner_vertices(count):
    """The Dirichlet forms need no solve there: their right-hand sides are rounding on the double."""
    angle = 2 * np.pi * np.arange(count) / count
    radii = 1 + 0.1 * np.random.default_rng(count).uniform(-1, 1, (2, count)) + [[0], [6.28 / count]]
    rings = np.stack([radii * np.cos(angle), radii * np.sin(angle), 0 * radii], axis=-1)
    inner, outer = np.arange(2 * count).reshape(2, count)
    after = np.roll(inner, -1), np.roll(outer, -1)
    faces = np.concatenate([np.stack([inner, outer, after[1]], 1), np.stack([inner, after[1], after[0]], 1)])
    ribbon = Surface(rings.reshape(-1, 3), faces)
    double = conformal_structure(ribbon, boundary="double_cover", solver="direct")
    assert_same(conformal_structure(ribbon), double)
    assert double.solver.residual < SAME


def test_a_closed_surface_needs_no_double():
    surface = surface_of(families.torus(7, 6))
    double = conformal_structure(surface, boundary="double_cover")
    assert np.array_equal(double.period_matrix, conformal_structure(surface).period_matrix)


def test_boundary_option():
    with pytest.raises(ValueError, match="boundary is 'open'"):
        conformal_structure(surface_of(BOUNDED["tube"]), boundary="open")
    with pytest.raises(TopologyError, match="a disk has no holomorphic forms"):
        conformal_structure(surface_of(families.hemisphere(3)), boundary="double_cover")
