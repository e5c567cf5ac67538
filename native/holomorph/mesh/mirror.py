"""The vertical plane in which a surface mirrors itself, as figures and props do that were modelled so."""

from dataclasses import dataclass

import numpy as np

from ..core.array_types import Flags, Integers
from .edges import following_corners, polygon_sides
from .surface import Surface

NEAR = 1e-3  # of the mean edge: places that are one
DIRECTIONS = (0.271, 0.577, 0.770), (0.802, -0.267, 0.534), (-0.123, 0.696, 0.707)  # along which few vertices are level


@dataclass(frozen=True)
class Mirror:
    """vertices : (#V,) the vertex on the other side; corners : (#C,) the corner of a polygon there; on_plane : (#V,)
    bool; half : (#F,) bool, the polygons on one side"""

    vertices: Integers
    corners: Integers
    on_plane: Flags
    half: Flags


def mirror_of(surface: Surface) -> Mirror | None:
    """The `Mirror` of a surface in a plane between x and -x, or y, or z, whichever are not up, through the middle of
    its box. None where there is none, polygons lie across it, no edge lies in it, or the surface has no
    positions. O(#C log #C)."""
    points = surface.vertices
    if points is None:
        return None
    near = NEAR * float(surface._native.edge_lengths.mean())
    for axis in sorted({0, 1, 2} - {"XYZ".index(surface.up)}):
        from_plane = points[:, axis] - (points[:, axis].min() + points[:, axis].max()) / 2
        reflected = points.copy()
        reflected[:, axis] -= 2 * from_plane
        on_plane = np.abs(from_plane) <= near
        sides = np.where(on_plane, 0, np.sign(from_plane))[surface.corner_vertices]
        lowest, highest = (each.reduceat(sides, surface.face_offsets[:-1]) for each in (np.minimum, np.maximum))
        half = highest > 0
        if not on_plane.any() or (half & (lowest < 0)).any() or 2 * np.count_nonzero(half) != len(half):
            continue
        twins = _same_places(points, reflected, near)
        corners = None if twins is None else _corners_of(surface, twins)
        if corners is not None:
            return Mirror(twins, corners, on_plane, half)
    return None


def _same_places(points, others, near):
    """(#V,) the one of the points at each other place; None where there are not as many pairs of one place each."""
    found, mine, its = np.full(len(points), -1), np.arange(len(points)), np.arange(len(points))
    for direction in DIRECTIONS:
        # Both in one order along a direction, but where two differ along it by less than rounding.
        mine, its = mine[np.argsort(points[mine] @ direction)], its[np.argsort(others[its] @ direction)]
        same = np.linalg.norm(points[mine] - others[its], axis=1) <= near
        found[its[same]] = mine[same]
        mine, its = mine[~same], its[~same]
        if not len(mine):
            return found
    return None


def _corners_of(surface, twins):
    """(#C,) the corner that is each one mirrored: there polygons run the other way round. None where some are missing,
    or sides are not told apart by their ends."""
    count = surface._native.vertex_count
    start, end = polygon_sides(surface).T
    keys, mirrored = start * count + end, twins[end] * count + twins[start]
    order = np.argsort(keys)
    at = np.minimum(np.searchsorted(keys, mirrored, sorter=order), len(order) - 1)
    if (keys[order[at]] != mirrored).any() or (np.diff(keys[order]) == 0).any():
        return None
    return following_corners(surface)[order[at]]
