"""The map of a part in islands: cut along hard edges, each piece flattened, pieces laid edge to edge as a paper net."""

import math
from dataclasses import dataclass, replace

import numpy as np

from . import _native, arrays
from .appearance import cost
from .array_types import Integers, Progress, Reals
from .cut_open import cut_open, on_border, paths_to_border
from .hard_edges import curvature, cuts_to_tips, is_hard
from .layout import pack
from .overlap import overlapping_part
from .quality import Quality
from .surface import Surface
from .value import Value, counted

HARD = 60.0  # degrees between two faces, from which on an artist expects a seam
MARGIN = 0.02  # between islands, in sides of the square that they are packed into
AXES = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))  # what is up on an island: the first that it shows
MANY = 1.0  # length of hard edges over the square root of the area, from which on these shape the part
FLAT = 2 * math.pi  # radians of curvature, all of it counted positive, up to which a part with several loops is tried
SHOWN = 0.2  # part of the area over which the axis is seen, from which on it counts
TURNED = 1e-3  # 1 less the cosine of an angle that is a turn
STRETCHED = 3.0  # factor of lengths, from which on a piece is also tried with cuts to its cone points
ROUNDS = 8  # of such cuts, at most
SAME = 1e-6  # UV distance over the size of the map, below which the two sides of an edge are at one place


@dataclass(frozen=True, eq=False, repr=False)
class Islands(Value):
    """A map in islands that lie beside each other, one unit of length on the surface a UV unit. Read-only arrays.

    uv : (#C, 2)
    seams : (#S, 2) vertices of the edges where the UVs jump
    count : of the islands
    soft_length, hard_length : of the seams across the smooth, and along hard edges, over the square root of the
        surface's area
    quality : `Quality`, also of how far islands lie over themselves
    evenness : from 0, conformal, to 1: how far squares of one size were preferred to angles
    """

    uv: Reals
    seams: Integers
    count: int
    soft_length: float
    hard_length: float
    quality: Quality
    evenness: float

    @property
    def cost(self) -> float:
        """See `appearance.cost`."""
        return cost(self.quality, 0, self.soft_length, self.hard_length)

    def _facts(self):
        return [counted(self.count, "island"), *self.quality._facts()]


def island_map(
    surface: Surface,
    hard_edges: float = HARD,
    *,
    evenness: float = 0.0,
    threads: int = 0,
    progress: Progress | None = None,
) -> Islands | None:
    """The `Islands` of a connected surface; None where a piece cannot be flattened, as where it is closed.

    The surface is cut along edges between faces that meet at more than an angle, from tips to these, and until all
    pieces are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more
    than a factor of 3, it is cut open to its cone points too if that looks better. Pieces are turned upright, and those
    that fit edge to edge are joined: first those that stay upright, longer edges first.

    Parameters
    ----------
    surface : Surface with positions
    hard_edges : degrees between the normals of two faces
    evenness : as in `Structure.tile`
    threads, progress : as in `conformal_structure`

    Raises Cancelled.
    """
    is_hard_edge = is_hard(surface, hard_edges)
    if not _may_be_flat(surface, is_hard_edge):
        return None
    cuts = _Cuts(surface, is_hard_edge, threads, progress)
    pieces = cuts.pieces()
    flat = _native.flattened(pieces._native, threads, progress)
    if not flat.is_flat.all():
        return None
    found = _laid_out(cuts, pieces, flat, evenness)
    for _ in range(ROUNDS if _stretch(flat).max() > math.log(STRETCHED) else 0):
        if not cuts.add_to_cones(pieces, _stretch(flat)):
            break
        pieces = cuts.pieces()
        flat = _native.flattened(pieces._native, threads, progress)
        if not flat.is_flat.all():
            return found
        found = min(found, _laid_out(cuts, pieces, flat, evenness), key=lambda made: made.cost)
    return found


def _may_be_flat(surface, is_hard_edge):
    """Whether to try: it is a disk, there are many hard edges, or little curvature. Else a cut would be one through
    the smooth."""
    if surface.boundary_count == 1 and surface.genus == 0:
        return True
    hard_length = surface._native.edge_lengths[is_hard_edge].sum()
    return hard_length > MANY * math.sqrt(surface.area) or surface.boundary_count and curvature(surface) < FLAT


def _stretch(flat):
    """(#V,) how far lengths change, as a logarithm."""
    with np.errstate(divide="ignore"):
        return np.nan_to_num(np.abs(np.log(flat.scale_factors)), nan=0.0)


class _Cuts:
    """Where a surface is cut. Pieces have its polygons and corners; triangles at cuts may be others."""

    def __init__(self, surface, is_hard_edge, threads, progress):
        self.surface, self.threads, self.progress = surface, threads, progress
        self.is_hard = is_hard_edge
        self.edges, self.following = _sides(surface)
        self.mask = is_hard_edge | cuts_to_tips(surface, is_hard_edge)
        self._add(_native.cuts_to_disks(self.pieces()._native, progress).astype(bool), self.pieces())

    def pieces(self):
        """A `Surface` of several components, more polygons at its end in small holes."""
        opened = cut_open(self.surface, self.mask)
        return Surface._of(_native.filled(opened._native))

    def add_to_cones(self, pieces, stretch):
        """Cuts each piece from where it stretches most to its border; False where none stretches by `STRETCHED`."""
        at = pieces._native.face_component[pieces.triangle_faces]
        worst = np.zeros(pieces._native.component_count)
        np.maximum.at(worst, at, stretch[pieces.triangles].max(axis=1))
        of_vertex = np.zeros(len(stretch), np.int64)
        of_vertex[pieces.triangles] = at[:, None]
        highest = np.flatnonzero((stretch == worst[of_vertex]) & (stretch > math.log(STRETCHED)))
        starts = np.zeros(len(stretch), bool)
        starts[highest[np.unique(of_vertex[highest], return_index=True)[1]]] = True
        no_seam = np.zeros(len(pieces._native.edges), bool)
        self._add(paths_to_border(pieces, on_border(pieces, no_seam), starts), pieces)
        return starts.any()

    def _add(self, cuts, pieces):
        """Edges of pieces, a mask."""
        edges, _ = _sides(pieces)
        self.mask[self.edges[cuts[edges[: len(self.edges)]]]] = True

    def joints(self):
        """(n, 4) corners at the two sides of each edge that is cut: start and end of the one, then of the other."""
        order = np.argsort(self.edges, kind="stable")
        edges = self.edges[order]
        first = np.flatnonzero((edges[1:] == edges[:-1]) & self.mask[edges[1:]])
        one, other = order[first], order[first + 1]
        return np.stack([one, self.following[one], other, self.following[other]], axis=1).astype(np.int32)


def _sides(surface):
    """(#C,) the edge of the side that starts at each polygon corner, its polygon on the left, and the corner at its
    end."""
    native, corners = surface._native, surface.triangle_corners
    is_side = native.triangle_edges < native.polygon_edge_count
    edges, following = np.zeros((2, len(surface.corner_vertices)), np.int64)
    edges[corners[is_side]] = native.triangle_edges[is_side]
    following[corners[is_side]] = np.roll(corners, -1, axis=1)[is_side]
    return edges, following


def _laid_out(cuts, pieces, flat, evenness):
    surface = cuts.surface
    uv = _native.evened_islands(pieces._native, flat, evenness, cuts.threads, cuts.progress)
    uv = _upright(pieces, uv)
    joints = cuts.joints()
    uv, nets = _native.joined(pieces._native, uv, _preferred(uv, joints), flat.is_flat)
    corners = len(surface.corner_vertices)
    uv, count = _packed(uv[:corners], nets[_corner_pieces(pieces)][:corners])
    seams = cuts.mask & ~_is_continuous(cuts, uv, joints)
    lengths = np.asarray(surface._native.edge_lengths) / math.sqrt(surface.area)
    visible = (float(lengths[seams & kind].sum()) for kind in (~cuts.is_hard, cuts.is_hard))
    ends = arrays.frozen(np.asarray(surface._native.edges)[seams])
    return Islands(arrays.frozen(uv), ends, count, *visible, _quality(cuts, pieces, flat, uv, evenness), evenness)


def _corner_pieces(pieces):
    """(#C,)"""
    return np.repeat(pieces._native.face_component, np.diff(pieces.face_offsets))


def _upright(pieces, uv):
    """The map with each piece turned about 0 so that the axis which it shows most of runs up."""
    z = uv @ [1, 1j]
    corners = z[pieces.triangle_corners]
    across = 0.5j * (
        np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    )  # times a height, summed: its gradient
    at, count = pieces._native.face_component[pieces.triangle_faces], pieces._native.component_count
    points = pieces.vertices[pieces.triangles]
    sides = points[:, 1:] - points[:, :1]
    areas = np.bincount(at, np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2, count)
    turn = np.ones(count, complex)
    is_open = np.ones(count, bool)
    for axis in AXES:
        rise = (across * (points @ axis)).sum(axis=1)
        slope = np.bincount(at, rise.real, count) + 1j * np.bincount(at, rise.imag, count)
        is_shown = is_open & (np.abs(slope) > SHOWN * areas)
        turn[is_shown] = 1j * np.abs(slope[is_shown]) / slope[is_shown]
        is_open &= ~is_shown
    z *= turn[_corner_pieces(pieces)]
    return np.stack([z.real, z.imag], axis=1)


def _preferred(uv, joints):
    """The joints whose pieces stay as they are turned first, and longer ones before shorter ones."""
    a, b, c, d = (uv @ [1, 1j])[joints.T]
    to, come = b - a, c - d
    lengths = np.abs(to)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.nan_to_num((to * np.conj(come)).real / (lengths * np.abs(come)), nan=-1.0)
    longest = lengths.max(initial=0.0) or 1.0
    return joints[np.lexsort((-np.round(lengths / longest, 6), cosine < 1 - TURNED))]


def _packed(uv, nets):
    """The UVs with nets side by side, and how many nets there are. nets : (#C,) the one of each corner"""
    names, nets = np.unique(nets, return_inverse=True)
    low, high = np.full((len(names), 2), np.inf), np.full((len(names), 2), -np.inf)
    np.minimum.at(low, nets, uv)
    np.maximum.at(high, nets, uv)
    places, _ = pack(high - low, MARGIN)
    return uv + (places - low)[nets], len(names)


def _is_continuous(cuts, uv, joints):
    """(#E,) whether the UVs are the same on both sides of an edge that is cut."""
    a, b, c, d = (uv @ [1, 1j])[joints.T]
    result = np.zeros(len(cuts.mask), bool)
    result[cuts.edges[joints[:, 0]]] = np.maximum(np.abs(a - d), np.abs(b - c)) <= SAME * np.ptp(uv, axis=0).max()
    return result


def _quality(cuts, pieces, flat, uv, evenness):
    """That on the triangles of the surface; what lies over itself is bounded by the seams and the boundary."""
    quality = Quality.of(cuts.surface._native, uv, cuts.threads)
    if evenness > 0:
        conformal = _native.evened_islands(pieces._native, flat, 0.0, cuts.threads, None)[: len(uv)]
        quality = quality.evened_from(Quality.of(cuts.surface._native, conformal, cuts.threads), evenness)
    is_border = cuts.mask | (np.bincount(cuts.edges, minlength=len(cuts.mask)) == 1)
    starts = np.flatnonzero(is_border[cuts.edges])
    border = (uv @ [1, 1j])[np.stack([starts, cuts.following[starts]], axis=1)]
    return replace(quality, overlapping_part=overlapping_part(border))
