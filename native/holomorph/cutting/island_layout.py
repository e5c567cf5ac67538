"""How the pieces of a surface that is cut are flattened, and laid edge to edge as a paper net."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Flags, Integers, Progress, Reals
from ..core.progress import tell
from ..core.value import Value, counted
from ..mesh.hard_edges import seen
from ..mesh.surface import Surface
from ..packing.layout import pack
from ..quality.appearance import HARD_SEAM, SEAM, cost, of_overlaps
from ..quality.direction import uphill
from ..quality.overlap import overlapping_part
from ..quality.quality import Quality
from .island_cuts import Cuts, corner_pieces

MARGIN = 0.02  # between islands, in sides of the square that they are packed into
# What is up on an island, by `Surface.up`: the first of these that it shows.
AXES = {
    "Y": ((0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)),
    "Z": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)),
}
SHOWN = 0.2  # part of the area over which the axis is seen, from which on it counts
TURNED = 1e-3  # 1 less the cosine of an angle that is a turn
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

    @property
    def seam_cost(self) -> float:
        """The part of the cost that is of seams."""
        return SEAM * self.soft_length + HARD_SEAM * self.hard_length

    @property
    def overlap_cost(self) -> float:
        """The part of the cost that is of islands that lie over themselves."""
        return of_overlaps(self.quality)

    def _facts(self):
        return [counted(self.count, "island"), *self.quality._facts()]


@dataclass(frozen=True, eq=False)
class Flattened:
    """A surface that is cut, its pieces, and their conformal maps with free boundaries.

    bends : (#E,) angles at the edges of the surface; is_upright : whether pieces are to stay so
    """

    surface: Surface
    bends: Reals
    is_upright: bool
    cuts: Cuts
    pieces: Surface
    flat: _native.Flattening
    threads: int
    progress: Progress | None

    @classmethod
    def of(
        cls, cuts: Cuts, bends: Reals, is_upright: bool, threads: int, progress: Progress | None
    ) -> Flattened | None:
        """None where a piece cannot be flattened, as where it is closed."""
        pieces = cuts.pieces()
        flat = _native.flattened(pieces._native, threads, progress)
        if not flat.is_flat.all():
            return None
        return cls(cuts.surface, bends, is_upright, cuts.copy(), pieces, flat, threads, progress)

    def evened(self, evenness: float) -> Reals:
        """(#C of the pieces, 2) UVs, each piece for itself."""
        return _native.evened_islands(self.pieces._native, self.flat, evenness, self.threads, self.progress)

    def laid_out(self, flat_uv: Reals, evenness: float, conformal: Islands | None = None) -> Islands:
        """The `Islands` of the UVs by `evened`. conformal : those for evenness 0, if it is another one"""
        (uv, is_held), joints = _upright(self.pieces, flat_uv), self.cuts.joints()
        may = self.flat.is_flat, is_held & self.is_upright  # be joined, and not be turned
        uv, nets = _native.joined(self.pieces._native, uv, _preferred(uv, joints), *may, self.progress)
        tell(self.progress, 0.0, "layout")
        corners = len(self.surface.corner_vertices)
        uv, count = _packed(uv[:corners], nets[corner_pieces(self.pieces)][:corners])
        seams = self.cuts.mask & ~_is_continuous(self.cuts, uv, joints)
        quality = self._quality(uv)
        if conformal is not None:
            quality = quality.evened_from(conformal.quality, evenness)
        ends = arrays.frozen(np.asarray(self.surface._native.edges)[seams])
        lengths = visible_lengths(self.surface, self.bends, seams)
        return Islands(arrays.frozen(uv), ends, count, *lengths, quality, evenness)

    def _quality(self, uv):
        """The `Quality` on the triangles of the surface; overlaps are measured within seams and boundary."""
        cuts = self.cuts
        is_border = cuts.mask | (np.bincount(cuts.edges, minlength=len(cuts.mask)) == 1)
        starts = np.flatnonzero(is_border[cuts.edges])
        border = (uv @ [1, 1j])[np.stack([starts, cuts.following[starts]], axis=1)]
        quality = Quality.of(self.surface._native, uv, self.threads)
        if self.is_upright:
            quality = quality.upright(uv, self.surface.up)
        return replace(quality, overlapping_part=overlapping_part(border, self.progress))


def visible_lengths(surface: Surface, bends: Reals, seams: Flags) -> tuple[float, float]:
    """The lengths of seams, (#E,) bool, across the smooth and along hard edges, over the root of the area."""
    lengths, soft = np.asarray(surface._native.edge_lengths)[seams], seen(bends[seams])
    root = math.sqrt(surface.area)
    return float((lengths * soft).sum()) / root, float((lengths * (1 - soft)).sum()) / root


def _upright(pieces, uv):
    """(The map with each piece turned about 0 so that the axis which it shows most of runs up, (#pieces,) whether that
    is what is up in space)"""
    at, count = pieces._native.face_component[pieces.triangle_faces], pieces._native.component_count
    points = pieces.vertices[pieces.triangles]
    sides = points[:, 1:] - points[:, :1]
    areas = np.bincount(at, np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2, count)
    turn = np.ones(count, complex)
    is_open, is_held = np.ones(count, bool), None
    for axis in AXES[pieces.up]:
        rise = uphill(pieces._native, uv, axis)
        slope = np.bincount(at, rise.real, count) + 1j * np.bincount(at, rise.imag, count)
        is_shown = is_open & (np.abs(slope) > SHOWN * areas)
        turn[is_shown] = 1j * np.abs(slope[is_shown]) / slope[is_shown]
        is_open &= ~is_shown
        is_held = is_shown if is_held is None else is_held
    z = (uv @ [1, 1j]) * turn[corner_pieces(pieces)]
    return np.stack([z.real, z.imag], axis=1), is_held


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
