"""Facets: a bevel between two of them is one hard edge, and what is smooth has none."""

import families
import numpy as np
import pytest
from holomorph import _native, island_map
from solved import surface_of

SMOOTH = {
    "cube": families.cube(),
    "coarse ball": families.geodesic_sphere(3),
    "fine ball": families.geodesic_sphere(12),
    "jittered ball": families.geodesic_sphere(5, jitter=0.3, seed=1),
    "coarse torus": families.torus(10, 6),
    "fine torus": families.torus(48, 24),
    "tube": families.cylinder(12, 4),
}


def bends(surface):
    return _native.bends(surface._native)


def breaks(surface):
    return _native.breaks(surface._native)


def rounded_box(inner, scale=1.0):
    """A box of side 2 whose edges are rounded by two strips each, from `inner` on."""
    mesh = families.voxel_surface(np.ones((3, 3, 3), bool))
    points = np.array([-1.0, -inner, inner, 1.0])[np.asarray(mesh.vertices, int)]
    core = np.clip(points, -inner, inner)
    off = points - core
    rounded = core + (1 - inner) * off / np.linalg.norm(off, axis=1, keepdims=True)
    return families.Mesh(scale * rounded, mesh.corners, mesh.offsets)


@pytest.mark.parametrize("name", SMOOTH)
def test_what_has_no_strips_breaks_off_as_its_faces_bend(name):
    surface = surface_of(SMOOTH[name])
    assert np.allclose(breaks(surface), bends(surface), rtol=0, atol=1e-9)


@pytest.mark.parametrize("scale", [1.0, 1e-3])
@pytest.mark.parametrize("inner", [0.9, 0.8])
def test_a_bevel_is_one_edge(inner, scale):
    """No edge of it bends by more than 45 degrees, and the sides meet at right angles along one line each."""
    surface = surface_of(rounded_box(inner, scale))
    found, lengths = breaks(surface), surface._native.edge_lengths / scale
    assert np.degrees(bends(surface).max()) < 50
    is_edge = found > bends(surface) + 1e-6
    assert np.allclose(np.degrees(found[is_edge]), 90, atol=1e-3)
    assert 12 * 2 * inner <= lengths[is_edge].sum() * (1 + 1e-9) <= 12 * 2.2
    made = island_map(surface, evenness=0.5)
    assert made.quality.mean_angle < 1.02 and made.soft_length < 0.02 and len(made.seams) < 40


@pytest.mark.parametrize("inner", [0.3, 0.5, 0.6])
def test_strips_as_wide_as_what_they_lie_between_are_smooth(inner):
    """A box rounded so far that it is nearly a ball; and two with strips that are somewhat narrower than its sides."""
    surface = surface_of(rounded_box(inner))
    assert np.allclose(breaks(surface), bends(surface), rtol=0, atol=1e-9)


def test_facets_do_not_depend_on_how_vertices_are_named():
    mesh = rounded_box(0.85)
    found = [np.sort(breaks(surface_of(one))) for one in (mesh, families.relabelled(mesh)[0])]
    assert np.allclose(*found, atol=1e-9)
