"""Degenerate geometry: coincident vertices, triangles without area, coordinates near the ends of doubles."""

import families
import numpy as np
import pytest
from holomorph import conformal_structure
from solved import surface_of


@pytest.mark.parametrize("cap", ["n-gon", "fan"])
@pytest.mark.parametrize("punctures", [None, (0, 130)])
def test_spun_spheres_have_a_map_everywhere(cap, punctures):
    """The vertices beside an automatic puncture coincide with it."""
    structure = conformal_structure(surface_of(families.spun(16, 8, cap)), punctures=punctures)
    uv = structure.uv(structure.balanced_coefficients())
    assert np.isfinite(uv).all()
    quality = structure.quality(uv)
    assert not quality.flipped.any() and not quality.collapsed.any()
    assert quality.mean_angle < 1.3
    assert np.isfinite(structure.sphere_map()).all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_triangles_without_finite_uvs_are_no_good_ones(value):
    structure = conformal_structure(surface_of(families.torus(6, 6)))
    uv = structure.uv(structure.balanced_coefficients()).copy()
    uv[structure._triangulation.triangle_corners[5, 1]] = value
    quality = structure.quality(uv)
    bad = np.flatnonzero(
        (structure._triangulation.triangle_corners == structure._triangulation.triangle_corners[5, 1]).any(axis=1)
    )
    assert np.array_equal(np.flatnonzero(quality.collapsed), bad)
    assert np.isfinite(quality.mean_angle) and np.isfinite(quality.density_ratio) and not quality.flipped[bad].any()


def test_a_map_to_a_point_has_collapsed():
    structure = conformal_structure(surface_of(families.torus(6, 6)))
    quality = structure.quality(np.zeros((len(structure.surface.corner_vertices), 2)))
    assert quality.collapsed.all() and np.isinf([quality.mean_angle, quality.density_ratio]).all()
