"""What all cells are checked for: that they are the surface, and which area they have."""

import numpy as np
from holomorph import Surface
from holomorph.mesh.edges import following_corners


def as_surface(cells):
    """A surface of the polygons, checked: no vertex twice in a polygon, no edge or vertex that is not manifold."""
    return Surface.from_polygons(cells.positions, cells.corner_vertices, cells.face_offsets)


def assert_same_topology(cells, surface):
    made = as_surface(cells)
    assert made._native.component_count == surface._native.component_count
    assert made.euler_characteristic == surface.euler_characteristic
    assert made.boundary_count == surface.boundary_count
    assert not len(made.repairs.reversed_faces) and not len(made.repairs.isolated_vertices)
    assert len(cells.uv) == len(cells.corner_vertices)


def inside(cells, uv):
    return np.linalg.solve(cells.tiled.lattice, uv.T).T


def polygon_areas(cells):
    """(#F,) signed, in tiles."""
    x, y = inside(cells, cells.uv).T
    follow = following_corners(cells)
    return np.add.reduceat(x * y[follow] - x[follow] * y, cells.face_offsets[:-1]) / 2
