"""Where a surface is cut into islands: at hard edges and tips, until all are disks, and to cone points."""

import copy
import math

import numpy as np

from .. import _native
from ..mesh.cut_open import cut_open, on_border, paths_to_border
from ..mesh.hard_edges import cuts_to_tips
from ..mesh.surface import Surface

STRETCHED = 2.5  # factor of lengths, from which on a piece is also tried with cuts to its cone points


class Cuts:
    """Where a surface is cut. Pieces have its polygons and corners; triangles at cuts may be others."""

    def __init__(self, surface, is_hard_edge, progress):
        self.surface = surface
        self.edges, self.following = sides_of(surface)
        self.mask = is_hard_edge | cuts_to_tips(surface, is_hard_edge)
        pieces = self.pieces()
        self.mask |= self._of(pieces, _native.cuts_to_disks(pieces._native, progress).astype(bool))

    def copy(self):
        """The same cuts, to which others may be added."""
        result = copy.copy(self)
        result.mask = self.mask.copy()
        return result

    def pieces(self):
        """A `Surface` of several components, more polygons at its end in small holes."""
        opened = cut_open(self.surface, self.mask)
        return Surface._of(_native.filled(opened._native))._standing_as(opened)

    def add(self, cuts):
        """Cuts these edges, too, (#E,) bool. Returns whether there were any."""
        self.mask |= cuts
        return bool(cuts.any())

    def to_cones(self, pieces, flat):
        """(#E,) paths from where pieces stretch most to their borders, of those that stretch by more than
        `STRETCHED`."""
        stretch = _stretch(flat)
        at = pieces._native.face_component[pieces.triangle_faces]
        worst = np.zeros(pieces._native.component_count)
        np.maximum.at(worst, at, stretch[pieces.triangles].max(axis=1))
        of_vertex = np.zeros(len(stretch), np.int64)
        of_vertex[pieces.triangles] = at[:, None]
        highest = np.flatnonzero((stretch == worst[of_vertex]) & (stretch > math.log(STRETCHED)))
        starts = np.zeros(len(stretch), bool)
        starts[highest[np.unique(of_vertex[highest], return_index=True)[1]]] = True
        no_seam = np.zeros(len(pieces._native.edges), bool)
        return self._of(pieces, paths_to_border(pieces, on_border(pieces, no_seam), starts))

    def across_overlaps(self, pieces, uv, progress):
        """(#E,) edges between the parts of pieces that lie over themselves, each of which does not."""
        return self._of(pieces, edges_between(pieces, _native.parted(pieces._native, uv, progress)))

    def _of(self, pieces, cuts):
        """(#E,) the edges of the surface that are these of its pieces, a mask."""
        edges, _ = sides_of(pieces)
        result = np.zeros(len(self.mask), bool)
        result[self.edges[cuts[edges[: len(self.edges)]]]] = True
        return result

    def joints(self):
        """(n, 4) corners at the two sides of each edge that is cut: start and end of the one, then of the other."""
        order = np.argsort(self.edges, kind="stable")
        edges = self.edges[order]
        first = np.flatnonzero((edges[1:] == edges[:-1]) & self.mask[edges[1:]])
        one, other = order[first], order[first + 1]
        return np.stack([one, self.following[one], other, self.following[other]], axis=1).astype(np.int32)


def sides_of(surface):
    """(#C,) the edge of the side that starts at each polygon corner, its polygon on the left, and the corner at its
    end."""
    native, corners = surface._native, surface.triangle_corners
    is_side = native.triangle_edges < native.polygon_edge_count
    edges, following = np.zeros((2, len(surface.corner_vertices)), np.int64)
    edges[corners[is_side]] = native.triangle_edges[is_side]
    following[corners[is_side]] = np.roll(corners, -1, axis=1)[is_side]
    return edges, following


def edges_between(surface, names):
    """(#E,) whether an edge lies between polygons of different names, (#F,) integers."""
    edges, _ = sides_of(surface)
    of_side = np.repeat(names, np.diff(surface.face_offsets))
    low, high = np.full(len(surface._native.edges), np.max(names)), np.full(len(surface._native.edges), np.min(names))
    np.minimum.at(low, edges, of_side)
    np.maximum.at(high, edges, of_side)
    return low < high


def _stretch(flat):
    """(#V,) how far lengths change, as a logarithm."""
    with np.errstate(divide="ignore"):
        return np.nan_to_num(np.abs(np.log(flat.scale_factors)), nan=0.0)


def corner_pieces(pieces):
    """(#C,)"""
    return np.repeat(pieces._native.face_component, np.diff(pieces.face_offsets))


def in_one_orientation(surface):
    """The surface with polygons turned round that are read in reverse, and (#C,) which corner each of its corners is:
    pieces would be oriented each by itself. Itself where there are none."""
    offsets, order = surface.face_offsets, np.arange(len(surface.corner_vertices))
    reversed_faces = surface._native.reversed_faces
    if not len(reversed_faces):
        return surface, order
    is_reversed = np.zeros(len(offsets) - 1, bool)
    is_reversed[reversed_faces] = True
    starts, ends = (np.repeat(bound, np.diff(offsets)) for bound in (offsets[:-1], offsets[1:]))
    order = np.where(np.repeat(is_reversed, np.diff(offsets)), starts + ends - 1 - order, order)
    corners = np.ascontiguousarray(surface.corner_vertices[order])
    native = _native.Surface.from_polygons(surface.vertices, corners, offsets)
    return Surface._of(native)._standing_as(surface), order
