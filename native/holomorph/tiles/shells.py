"""Solids before they are carved: closed shells each the right way round, outer ones outwards, hollows in them inwards;
and with triangles small enough.
"""

import numpy as np

from ..mesh.surface import Surface
from .relief import volume

SAMPLES = 5  # vertices of a shell that decide whether it lies inside another one, by most of them
FEW = 200  # triangles: the star of a pole is to be a small part of all


def outward(surface):
    """(the surface with every closed part the right way round, how many were not), see `inside_out`."""
    wrong = inside_out(surface.components)
    return (_turned(surface, wrong), len(wrong)) if wrong else (surface, 0)


def inside_out(parts):
    """The closed ones of some parts that are the wrong way round. A part lies as deep as there are closed parts around
    it: at an even depth it bounds the solid from outside, and its volume is positive."""
    closed = [part for part in parts if not part.boundary_count]
    boxes = np.array([[part.vertices.min(axis=0), part.vertices.max(axis=0)] for part in closed]).reshape(-1, 2, 3)
    wrong = []
    for k, part in enumerate(closed):
        around = np.flatnonzero((boxes[:, 0] <= boxes[k, 0]).all(axis=1) & (boxes[:, 1] >= boxes[k, 1]).all(axis=1))
        depth = sum(_is_inside(part, closed[other]) for other in around if other != k)
        if (-1) ** depth * volume(part.vertices, part.triangles) < 0:
            wrong.append(part)
    return wrong


def turned_sentence(count):
    """What is said of shells that were turned."""
    return f"{count} shells were inside out: they were turned" if count > 1 else "1 shell was inside out: it was turned"


def _is_inside(part, other):
    step = max(len(part.vertices) // SAMPLES, 1)
    found = [abs(winding_number(other, point)) > 0.5 for point in part.vertices[::step][:SAMPLES]]
    return 2 * sum(found) > len(found)


def winding_number(surface, point):
    """How often a closed surface goes around a point: the sum of the solid angles of its triangles, over 4 pi (van
    Oosterom and Strackee 1983, doi:10.1109/TBME.1983.325207)."""
    a, b, c = np.moveaxis(surface.vertices[surface.triangles] - point, 1, 0)
    p, q, r = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = [np.einsum("ij,ij->i", *pair) for pair in ((a, b), (b, c), (c, a))]
    return float(np.arctan2(volume, p * q * r + dots[0] * r + dots[1] * p + dots[2] * q).sum() / (2 * np.pi))


def _turned(surface, parts):
    """The surface with the faces of some parts the other way round."""
    is_wrong = np.isin(surface.face_index, np.concatenate([part.face_index for part in parts]))
    starts, ends = surface.face_offsets[:-1], surface.face_offsets[1:]
    corners = np.arange(len(surface.corner_vertices))
    back = np.where(np.repeat(is_wrong, ends - starts), np.repeat(starts + ends - 1, ends - starts) - corners, corners)
    arrays = surface.vertices, surface.corner_vertices[back], surface.face_offsets
    return Surface.from_polygons(*arrays, strict=False)._standing_as(surface)


def with_room(surface):
    """A closed part without handles with its triangles cut in four, at the midpoints of their sides, until they are not
    few; others as they are."""
    if surface.genus or surface.boundary_count:
        return surface
    while len(surface.triangles) < FEW:
        surface = _quartered(surface)
    return surface


def _quartered(surface):
    native, corners = surface._native, surface.triangles
    middle = len(surface.vertices) + native.triangle_edges  # of the sides from each corner to the next
    at_corners = np.stack([corners, middle, np.roll(middle, 1, axis=1)], axis=2).reshape(-1, 3)
    middles = surface.vertices[native.edges].mean(axis=1)
    return Surface(np.concatenate([surface.vertices, middles]), np.concatenate([at_corners, middle]))
