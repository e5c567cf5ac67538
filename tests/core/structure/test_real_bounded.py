"""Every real mesh with a boundary that is not a disk: certificates, exact integers, straight boundaries, UV area 1."""

import numpy as np
import pytest
from boundaries import boundary_edges, boundary_sides, handles_of, least_eigenvalue, signed_area, size
from forms import determinant
from holomorph import BoundedStructure, Surface, conformal_structure
from shared_data import REAL, real_file

SOLVER = 1e-8

SMALL = [
    "beetle_59k_b11.obj",
    "bunny_stanford_raw.ply",
    "inverted_triangles_b6.obj",
    "lionstatue_g3_b1.obj",
    "makehuman_base_quads.obj",
    "plane_b27.obj",
    "punctured_torus.obj",
    "rna_4U4Q_7.off",
    "suzanne_blender.obj",
    "teapot_bff.obj",
]
LARGE = ["pizza_g73_b1.obj", "big_brain_cit168_half_open.ply.gz"]

pytestmark = pytest.mark.skipif(not REAL, reason="no folder ../shared/meshes")
results = {}


@pytest.fixture
def structures(name, tmp_path):
    """Structures of all components with a boundary, disks left out."""
    if name not in results:
        parts = Surface.read(real_file(name, tmp_path)).components
        wanted = [part for part in parts if part.boundary_count and 2 * part.genus + part.boundary_count > 1]
        assert wanted
        results[name] = [conformal_structure(part) for part in wanted]
    return results[name]


@pytest.mark.parametrize("name", SMALL + LARGE)
def test_certificates(structures):
    for structure in structures:
        assert isinstance(structure, BoundedStructure)
        assert max(vars(structure.residuals).values()) < SOLVER
        W, handles = structure.pairing, handles_of(structure)
        assert abs(determinant(W)) == 1
        assert not W[:handles, handles:].any()
        assert (W[handles:, handles:] == np.eye(len(W) - handles)).all()
        omega = structure.period_matrix
        assert size(omega - omega.T) < SOLVER * size(omega)
        assert np.linalg.eigvalsh(omega.imag).min() > 0


@pytest.mark.parametrize("name", SMALL + LARGE)
def test_bounds(structures):
    for structure in structures:
        natural, dirichlet = structure.gram_matrices
        lower = structure.pairing @ np.linalg.inv(dirichlet) @ structure.pairing.T
        projected = structure.projected_gram_matrices[0]
        slack = SOLVER * size(natural)
        assert least_eigenvalue(projected - lower) > -slack
        assert least_eigenvalue(natural - projected) > -slack


@pytest.mark.parametrize("name", SMALL)
def test_boundaries_are_straight_bit_for_bit(structures):
    for structure in structures:
        uv = structure.uv(structure.balanced_coefficients())
        ends = boundary_sides(structure)
        assert (uv[ends[:, 0], 1] == uv[ends[:, 1], 1]).all()
        assert not structure.dirichlet_forms[:, boundary_edges(structure)].any()


@pytest.mark.parametrize("name", SMALL)
def test_maps(structures):
    """Finite, of area 1. Besides the triangles on one loop only such collapse as lie in a pocket that hangs on a single
    edge."""
    for structure in structures:
        uv = structure.uv(structure.balanced_coefficients())
        assert np.isfinite(uv).all()
        assert abs(signed_area(structure, uv) - 1) < SOLVER
        quality = structure.quality(uv)
        assert np.isfinite(quality.mean_angle)
        collapsed = structure.collapsed_triangles
        assert quality.collapsed[collapsed].all() or structure.surface.repairs
        assert quality.collapsed.sum() <= len(collapsed) + max(2, 1e-3 * len(quality.collapsed))


@pytest.mark.parametrize(
    ("name", "most"), [("beetle_59k_b11.obj", 1.1), ("inverted_triangles_b6.obj", 1.1), ("punctured_torus.obj", 1.05)]
)
def test_angles(structures, most):
    (structure,) = structures
    assert structure.quality(structure.uv(structure.balanced_coefficients())).mean_angle < most
