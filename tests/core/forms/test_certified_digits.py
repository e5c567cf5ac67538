"""Certified digits: periods of surfaces whose curves are known, to eight of them, and what is decided by them."""

from functools import cache

import dessins
import flat_cones
import numpy as np
import pytest
import sextics
from curve_periods import curve_period_matrix
from holomorph import conformal_structure, conformally_equivalent, igusa_invariants
from solved import surface_of

EIGHT = 1e-8
SIX_DIGITS = [23, 37]  # whose invariants are also compared
POLYGONS = {8: [1, 0, 0, 0, -1, 0], 10: [1, 0, 0, 0, 0, -1], 14: [1, 0, 0, 0, 0, 0, 0, -1]}


def solved(flat, bounds):
    structure = conformal_structure(surface_of(flat), bounds=bounds)
    assert structure.refinement.reached and structure.certificate.holds
    assert structure.certificate.relative_width <= bounds
    return structure


@cache
def modular(N):
    return solved(dessins.modular_curve(N), EIGHT if N in SIX_DIGITS else 1e-6)


def check(structure, curve):
    """The exact periods are within the bounds, and the projected ones far nearer than the bounds say."""
    found = conformally_equivalent(structure, curve_period_matrix(curve))
    assert found.verdict in {"indistinguishable", "mirror_image"}
    assert found.residual < structure.certificate.relative_width / 10
    assert found.tolerance < 2 * structure.certificate.relative_width


@pytest.mark.parametrize("N", dessins.ELLIPTIC)
def test_modular_curves_of_genus_1(N):
    """They are glued of 24 to 96 flat triangles."""
    check(solved(dessins.modular_curve(N), EIGHT), dessins.curve(N))


@pytest.mark.parametrize("N", dessins.HYPERELLIPTIC)
def test_modular_curves_of_genus_2_and_3(N):
    check(modular(N), dessins.curve(N))


@pytest.mark.parametrize("sides", POLYGONS)
def test_regular_polygons(sides):
    """Eight triangles, whose linear functions leave the octagon wider than its periods are."""
    structure = solved(flat_cones.regular_polygon(sides), EIGHT)
    assert structure.refinement.levels[0][1] > 1
    check(structure, POLYGONS[sides])


@pytest.mark.parametrize("n", [5, 7])
def test_double_polygons(n):
    """Thin triangles, all of whose corners are one cone point."""
    check(solved(flat_cones.double_polygon(n), EIGHT), [1, *[0] * (n - 1), -1])


@pytest.mark.parametrize("shape", [(1.0, 1.2, 0.9), (0.4, 1.0, 1.7)], ids=str)
def test_triangles_of_any_shape_glue_to_the_same_surface(shape):
    angles = (*shape[:2], np.pi - shape[0] - shape[1])
    check(solved(dessins.modular_curve(11, angles), EIGHT), dessins.curve(11))


@pytest.mark.parametrize("N", SIX_DIGITS)
def test_six_digits_of_igusa_invariants(N):
    found, exact = igusa_invariants(modular(N)), np.array([float(x) for x in sextics.absolute(dessins.curve(N))])
    assert (np.abs(found - exact) < 1e-6 * np.abs(exact)).all()


@pytest.mark.parametrize("change", [1e-3, 1e-6])
def test_near_curves_are_told_apart(change):
    structure = solved(flat_cones.regular_polygon(10), change / 10)
    near = conformally_equivalent(structure, curve_period_matrix([1, 0, 0, 0, change, -1]))
    assert near.verdict == "not_equivalent" and near.is_proven
