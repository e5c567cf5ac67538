"""The map of a part in islands: cut along hard edges, each piece flattened, pieces laid edge to edge as a paper net."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.progress import scaled
from ..core.value import Value, counted
from ..mesh.checks import check_threads, check_type, checked_evenness, real_number
from ..mesh.surface import Surface
from ..packing.layout import pack
from ..quality.appearance import cost
from ..quality.overlap import overlapping_part
from ..quality.quality import Quality
from .hard_edges import bends, curvature, seen
from .island_cuts import Cuts, corner_pieces, in_one_orientation

HARD = 60.0, 40.0, 30.0  # degrees between two faces, from which on a seam is expected, if need be
SMOOTH = 35.0  # degrees: a part without sharper edges is a coarse mesh of something smooth
FINE = 0.3  # cost of the squares, from which on no other angle is tried
MARGIN = 0.02  # between islands, in sides of the square that they are packed into
AXES = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))  # what is up on an island: the first that it shows
MANY = 1.0  # length of hard edges over the square root of the area, from which on these shape the part
FLAT = 2 * math.pi  # radians of curvature, all of it counted positive, up to which a part with several loops is tried
SHOWN = 0.2  # part of the area over which the axis is seen, from which on it counts
TURNED = 1e-3  # 1 less the cosine of an angle that is a turn
CONES, ROUNDS = 8, 4  # at most: cuts of each piece to cone points in a round, and rounds
SAME = 1e-5  # UV distance over the size of the map, below which the two sides of an edge are at one place


@dataclass(frozen=True, eq=False, repr=False)
class Islands(Value):
    """A map in islands that lie beside each other, one unit of length on the surface a UV unit. Read-only arrays.

    uv : (#C, 2)
    seams : (#S, 2) vertices of the edges where the UVs jump
    count : of the islands
    soft_length, hard_length : of the seams across the smooth, and along hard edges that hide them, over the square root
        of the surface's area
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
        """The cost to the eye, see `appearance.cost`."""
        return cost(self.quality, 0, self.soft_length, self.hard_length)

    def _facts(self):
        return [counted(self.count, "island"), *self.quality._facts()]


def island_map(
    surface: Surface,
    hard_edges: float | None = None,
    *,
    evenness: float = 0.0,
    threads: int = 0,
    progress: Progress | None = None,
) -> Islands | None:
    """The `Islands` of a connected surface; None where a piece cannot be flattened, as where it is closed.

    The surface is cut along edges between faces that meet at more than an angle, from tips to these, and until all
    pieces are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more
    than a factor of 2.5, it is cut open to its cone points too if that looks better, and parted where it lies over
    itself. Pieces are turned upright, and those that fit edge to edge are joined: first those that stay upright, longer
    edges first.

    Parameters
    ----------
    surface : Surface with positions
    hard_edges : degrees between the normals of two faces; None for 60, and for 40 and 30 where pieces stretch or lie
        over themselves, whichever looks best
    evenness : as in `Structure.tile`
    threads, progress : as in `conformal_structure`

    Raises Cancelled."""
    check_type(surface, Surface)
    evenness, threads = checked_evenness(evenness), check_threads(threads or None)
    hard_edges = None if hard_edges is None else real_number(hard_edges, "hard_edges", positive=True)
    progress = scaled(progress, 0.0, 0.0)  # whether to go on; how long it takes is not known
    given, (surface, order) = surface, in_one_orientation(surface)
    bent, found = bends(surface), None
    first, *_ = angles = HARD if hard_edges is None else (hard_edges,)
    for degrees in angles:
        is_hard_edge = bent > np.radians(degrees)
        may_be_flat = degrees == first and _may_be_flat(surface)
        is_shaped = (found or degrees > SMOOTH) and _is_shaped_by(surface, is_hard_edge)
        if not may_be_flat and not is_shaped:
            continue
        found = _better(found, _Layout(surface, bent, evenness, threads, progress).along(is_hard_edge))
        if found and cost(found.quality) <= FINE:
            break
    if found is None or surface is given:
        return found
    uv = np.empty_like(found.uv)
    uv[order] = found.uv
    of_corners = {"overlapping_part": found.quality.overlapping_part, "unseen_angle": found.quality.unseen_angle}
    return replace(found, uv=arrays.frozen(uv), quality=replace(Quality.of(given._native, uv, threads), **of_corners))


def one_island(surface, tiling):
    """The `Islands` of a map whose jumps are not whole tiles any more, since a UV unit is to be one of length."""
    size = math.sqrt(tiling.quality.median_density)
    ends = surface.vertices[tiling.seams]
    soft = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() / math.sqrt(surface.area)
    quality = tiling.quality.of_density(1.0)
    return Islands(arrays.frozen(tiling.uv / size), tiling.seams, 1, float(soft), 0.0, quality, tiling.evenness)


def _better(found, made):
    return made if found is None or made is not None and made.cost < found.cost else found


def _may_be_flat(surface):
    """Whether to try where no edge is hard: it is a disk, or has little curvature. Else a cut would be one through the
    smooth."""
    is_disk = (surface.genus, surface.boundary_count) == (0, 1)
    return is_disk or surface.boundary_count > 0 and curvature(surface) < FLAT


def _is_shaped_by(surface, is_hard_edge):
    """Whether there are many hard edges."""
    return surface._native.edge_lengths[is_hard_edge].sum() > MANY * math.sqrt(surface.area)


@dataclass(frozen=True)
class _Layout:
    """How islands are made of a surface, whose edges are bent by angles, (#E,)."""

    surface: Surface
    bends: Reals
    evenness: float
    threads: int
    progress: Progress | None

    def along(self, is_hard_edge):
        """The `Islands`, cut along these edges, (#E,) bool; to cone points and across overlaps if that looks better."""
        cuts, found = Cuts(self.surface, is_hard_edge, self.progress), None
        for _ in range(ROUNDS):
            pieces, flat = self._flattened(cuts)
            if flat is None:
                break
            made, uv = self._laid_out(cuts, pieces, flat)
            found = _better(found, made)
            if not self._cut_to_cones(cuts, pieces, flat) and not cuts.add(cuts.across_overlaps(pieces, uv)):
                break
        return found

    def _flattened(self, cuts):
        """The pieces, and their flat maps, None where one has none."""
        pieces = cuts.pieces()
        flat = _native.flattened(pieces._native, self.threads, self.progress)
        return pieces, flat if flat.is_flat.all() else None

    def _cut_to_cones(self, cuts, pieces, flat):
        """Whether there was a piece to cut; of each one after the other, until none stretches."""
        count = 0
        while flat is not None and count < CONES and cuts.add(cuts.to_cones(pieces, flat)):
            pieces, flat = self._flattened(cuts)
            count += 1
        return count > 0

    def _laid_out(self, cuts, pieces, flat):
        """The `Islands`, and UVs of the pieces before they are laid edge to edge."""
        flat_uv = _native.evened_islands(pieces._native, flat, self.evenness, self.threads, self.progress)
        uv, joints = _upright(pieces, flat_uv), cuts.joints()
        uv, nets = _native.joined(pieces._native, uv, _preferred(uv, joints), flat.is_flat)
        corners = len(self.surface.corner_vertices)
        uv, count = _packed(uv[:corners], nets[corner_pieces(pieces)][:corners])
        seams = cuts.mask & ~_is_continuous(cuts, uv, joints)
        native = self.surface._native
        ends, lengths = np.asarray(native.edges)[seams], np.asarray(native.edge_lengths)[seams]
        soft = seen(self.bends[seams])
        visible = (float((lengths * part).sum()) / math.sqrt(self.surface.area) for part in (soft, 1 - soft))
        quality = self._quality(cuts, pieces, flat, uv)
        return Islands(arrays.frozen(uv), arrays.frozen(ends), count, *visible, quality, self.evenness), flat_uv

    def _quality(self, cuts, pieces, flat, uv):
        """The `Quality` on the triangles of the surface; overlaps are measured within seams and boundary."""
        native = self.surface._native
        quality = Quality.of(native, uv, self.threads)
        if self.evenness > 0:
            conformal = _native.evened_islands(pieces._native, flat, 0.0, self.threads, None)[: len(uv)]
            quality = quality.evened_from(Quality.of(native, conformal, self.threads), self.evenness)
        is_border = cuts.mask | (np.bincount(cuts.edges, minlength=len(cuts.mask)) == 1)
        starts = np.flatnonzero(is_border[cuts.edges])
        border = (uv @ [1, 1j])[np.stack([starts, cuts.following[starts]], axis=1)]
        return replace(quality, overlapping_part=overlapping_part(border))


def _upright(pieces, uv):
    """The map with each piece turned about 0 so that the axis which it shows most of runs up."""
    z = uv @ [1, 1j]
    corners = z[pieces.triangle_corners]
    across = 0.5j * (np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1))  # times heights, summed: gradients
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
    z *= turn[corner_pieces(pieces)]
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
