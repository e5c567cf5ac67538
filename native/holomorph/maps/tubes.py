"""Tubes, around which whole tiles lie. Windows in them, such as where a handle is fixed, are closed for the map."""

from dataclasses import replace

import numpy as np

from ..core import arrays
from ..mesh.edges import around_boundary, boundary_edges
from ..mesh.surface import Surface
from ..quality.quality import Quality
from .map import Map

ENDS = 2  # the longest boundary loops of a tube


def is_tube(surface: Surface) -> bool:
    """Whether the surface is a sphere with two holes."""
    return (surface.genus, surface.boundary_count) == (0, ENDS)


def closed(surface: Surface) -> Surface:
    """The surface with one more polygon, at the end, in each boundary loop but the `ENDS` longest; itself where there
    are no more. Vertices, polygons and corners keep their numbers.

    Raises InvalidMesh where a window is not a polygon.
    """
    start, end = boundary_edges(surface).T
    names = _loops(start, end, len(surface.vertices))
    sides = np.linalg.norm(surface.vertices[end] - surface.vertices[start], axis=1)
    loops, first = np.unique(names, return_inverse=True)
    lengths = np.bincount(first, np.round(sides / sides.max(), 9))
    windows = loops[np.lexsort((loops, -lengths))][ENDS:]
    if not len(windows):
        return surface
    polygons = [around_boundary(surface, start[names == name])[::-1] for name in windows]
    corners = np.concatenate([surface.corner_vertices, *polygons])
    offsets = np.concatenate([surface.face_offsets, len(surface.corner_vertices) + np.cumsum([*map(len, polygons)])])
    return Surface.from_polygons(surface.vertices, corners, offsets)._standing_as(surface)


def opened(made: Map, surface: Surface) -> Map:
    """The tiling of a surface with closed windows, on the surface itself."""
    if made.surface is surface:
        return made
    uv = arrays.frozen(made.uv[: len(surface.corner_vertices)])
    quality = replace(Quality.of(surface._native, uv, 0), unseen_angle=made.quality.unseen_angle)
    return replace(made, surface=surface, uv=uv, quality=quality, tiling=replace(made.tiling, uv=uv, quality=quality))


def _loops(start, end, count):
    """The lowest vertex of the loop of each edge, by pointer doubling."""
    following = np.arange(count)
    following[start] = end
    lowest = np.minimum(np.arange(count), following)
    for _ in range(len(start).bit_length()):
        lowest, following = np.minimum(lowest, lowest[following]), following[following]
    return lowest[start]
