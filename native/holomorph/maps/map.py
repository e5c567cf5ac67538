"""The UV map of one connected part, of whichever kind."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import Value
from ..cutting.island_layout import Islands
from ..forms.pole_structure import PoleStructure
from ..mesh.checks import check_type, checked_evenness
from ..mesh.folds import folds
from ..mesh.surface import Surface
from ..quality.appearance import CONE, HARD_SEAM, POLE, SEAM, cost
from ..quality.distortion import WorstPlace, drawn_density, worst_places
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, verdict
from ..tiles.tiled_surface import TiledSurface
from ..tiling.tilings import Tiling, vertices_of
from .automatic_structure import AnyStructure
from .mixed import Mixed

# Times the root of its own area that a map is wide: single precision has no room for others then.
SCATTERED = _native.scattered


@dataclass(frozen=True, eq=False, repr=False)
class Map(Value):
    """Result of `automatic_map`. All arrays are read-only; vertices are those of `surface`.

    surface : Surface, connected
    structure : the conformal structure that the map is made of, or beside
    uv : (#C, 2) UVs. Those of a tiling may be multiplied and moved by integers only
    quality : `Quality`
    coefficients : (n,) with which `structure.uv` gives the map; (0,) for a map of another kind
    why : why it is this map, in one sentence
    tiling : `Tiling`, None for other kinds
    islands : `Islands`, None for other kinds
    mixed : `Mixed`, None for other kinds
    """

    surface: Surface
    structure: AnyStructure
    uv: Reals
    quality: Quality
    coefficients: Complexes | Reals
    why: str
    tiling: Tiling | None = None
    islands: Islands | None = None
    mixed: Mixed | None = None
    _evenness: float = 0.0

    @classmethod
    def of_core(cls, made: _native.Map, surface: Surface, structure: AnyStructure) -> Map:
        """The one that the core made of a connected surface, with its structure for Python."""
        if made.tiling:
            tiling = Tiling.of_core(made.tiling, surface)
            return cls(surface, structure, tiling.uv, tiling.quality, np.empty(0), made.why, tiling)
        if made.islands:
            flat = Islands.of(made.islands, surface)
            flat = replace(flat, seams=vertices_of(surface, flat.seams))
            return cls(surface, structure, flat.uv, flat.quality, np.empty(0), made.why, islands=flat)
        uv = made.uv
        if made.mixed:
            quality = Quality._of(made.quality, None, surface.up)
            mixed = Mixed.of_core(made.mixed, uv, quality, surface)
            return cls(surface, structure, uv, quality, np.empty(0), made.why, mixed=mixed)
        coefficients = made.forms.coefficients.ravel()
        if structure.coefficient_type is np.float64:
            coefficients = coefficients.real.copy()
        quality = Quality._of(made.quality, structure._triangulation, surface.up)
        evenness = made.forms.evenness
        return cls(surface, structure, uv, quality, arrays.frozen(coefficients), made.why, _evenness=evenness)

    @property
    def kind(self) -> str:
        """What the map is.

        "tiling" : without visible seams under a texture that tiles
        "forms" : a combination of holomorphic forms, cut along seams
        "strip" : an annulus as a rectangle whose two other sides are a seam
        "log" : around poles, which lie at infinity, also a sphere as a strip
        "disk", "rectangle" : a disk with a round or straight boundary
        "flat" : in one piece, with a free boundary
        "islands" : in flat pieces
        "mixed" : in pieces between hard edges, some of them tilings, the rest flat
        """
        if self.mixed:
            return "mixed"
        if self.islands:
            return "islands" if self.islands.count > 1 or len(self.islands.seams) else "flat"
        return "tiling" if self.tiling else self.structure.map_kind

    @property
    def own(self) -> Tiling | Islands | Mixed | None:
        """The map itself, where it is not one of the forms of its structure."""
        return self.tiling or self.islands or self.mixed

    @property
    def is_tiled(self) -> bool:
        """Whether a texture breaks off when the UVs are moved by anything but whole tiles."""
        return bool(self.tiling or self.mixed)

    @property
    def cost(self) -> float:
        """The cost to the eye, see `appearance.cost`; infinite for a map that is `SCATTERED`."""
        size = np.ptp(self.uv, axis=0).max() if len(self.uv) else 0.0
        if size > SCATTERED * math.sqrt(self.density * self.surface.area):
            return math.inf
        return cost(self.quality, len(self.poles), *self._seam_lengths, len(self.cones))

    @cached_property
    def seen(self) -> Seen:
        """What is seen of it besides its squares."""
        soft, hard = self._seam_lengths
        poles, cones = len(self.poles), len(self.cones)
        costs = SEAM * soft + HARD_SEAM * hard + POLE * poles + CONE * cones
        native = self.surface._native
        folded = 0.0 if self.surface.vertices is None else self._over_size(native.edge_lengths[folds(self.surface)])
        lines = next((made.lines for made in self._tilings), "none")
        return Seen(costs, soft, hard, poles if self.is_tiled or poles else None, self.turns, cones, lines, folded)

    @property
    def _seam_lengths(self):
        """(length of the seams across the smooth, and along hard edges) over the root of the area."""
        if self.islands or self.mixed:
            return (self.islands or self.mixed).soft_length, (self.islands or self.mixed).hard_length
        lengths = self.structure._triangulation.edge_lengths[self.structure.seams]
        return 0.0 if self.tiling else self._over_size(lengths), 0.0

    def _over_size(self, lengths):
        return float(lengths.sum()) / math.sqrt(self.surface.area) if self.surface.area > 0 else 0.0

    @property
    def verdict(self) -> Verdict:
        """The `Verdict` on the map."""
        return verdict(self.quality, self.seen)

    @property
    def evenness(self) -> float:
        """From 0, conformal, to 1: how far squares of one size were preferred to angles."""
        return self.own.evenness if self.own else self._evenness

    @cached_property
    def seams(self) -> Integers:
        """(#S, 2) vertices of the edges where the UVs jump."""
        if self.own:
            return self.own.seams
        return self._of_surface(self.structure._triangulation.edges[self.structure.seams])

    @cached_property
    def poles(self) -> Integers:
        """(k,) vertices around which the UVs change by a residue."""
        if self.tiling or self.mixed:
            return (self.tiling or self.mixed).poles
        is_log = not self.islands and isinstance(self.structure, PoleStructure)
        return self._of_surface(self.structure._native.poles() if is_log else np.empty(0, np.int32))

    @property
    def turns(self) -> int:
        """2, 4 or 6 where the UVs may turn by this part of a full turn across a seam, see `Tiling.turns`; else 1."""
        return max((made.turns for made in self._tilings), default=1)

    @property
    def cones(self) -> Integers:
        """(k,) vertices with another angle around them than elsewhere, of all tilings that turn."""
        return arrays.frozen(np.concatenate([np.empty(0, np.int64), *(made.cones for made in self._tilings)]))

    @property
    def cone_angles(self) -> Reals:
        """(k,) the angles around `cones` in full turns: 3/4 where three squares meet."""
        return arrays.frozen(np.concatenate([np.empty(0), *(made.cone_angles for made in self._tilings)]))

    @property
    def jumps(self) -> Integers:
        """(k, 3) turns and translations of the UVs, see `Tiling.jumps`: across `seams` of a tiling that turns; of a map
        in pieces across the seams of those of its tilings that do, one after the other."""
        return arrays.frozen(np.concatenate([np.empty((0, 3), np.int64), *(made.jumps for made in self._tilings)]))

    @property
    def _tilings(self):
        return [self.tiling] if self.tiling else self.mixed.tilings if self.mixed else ()

    @cached_property
    def tiled(self) -> TiledSurface:
        """The surface under the tiling, where things are placed in tiles. Raises TopologyError for a map that is
        none."""
        if not self.tiling:
            raise TopologyError(f'the map is not a tiling: its kind is {self.kind!r}; main="seamless" makes one')
        return TiledSurface(self.surface, self.uv, self.tiling.lattice, turns=self.turns)

    @cached_property
    def density(self) -> float:
        """UV area per area of the surface, the median by that over the triangles that are drawn: tiles of a tiling.
        An intrinsic surface is not drawn."""
        drawn = self.surface.vertices is not None
        return drawn_density(self.surface, self.uv) if drawn else self.quality.median_density

    @cached_property
    def worst_places(self) -> dict[str, WorstPlace]:
        """Where an eye finds the map worst, apart from its poles: `face`, `position` and `value` of the "largest" and
        the "smallest" squares (a side over that at the median density) and of the most "sheared" ones (s1 / s2).
        Empty for an intrinsic surface, and where all faces are at poles."""
        return {} if self.surface.vertices is None else worst_places(self.surface, self.uv, self.poles)

    @property
    def unit_length(self) -> float:
        """Length on the surface of a UV unit where the density is the median one; 0 for a map without area."""
        return 1 / math.sqrt(self.density) if self.density > 0 else 0.0

    def of_copy(self, surface: Surface, structure: AnyStructure | None, scale: float) -> Map:
        """The same map of a copy of the part, whose lengths are multiplied by `scale`."""
        quality = self.quality.of_copy(scale)
        return replace(
            self,
            surface=surface,
            structure=structure or self.structure.of_copy(surface),
            quality=quality,
            tiling=self.tiling and replace(self.tiling, quality=quality),
            islands=self.islands and replace(self.islands, quality=quality),
            mixed=self.mixed and replace(self.mixed, quality=quality),
        )

    def _facts(self):
        return [self.kind, self.why, self.verdict.level]

    def _of_surface(self, vertices):
        component = self.surface.components[0]
        return arrays.frozen(vertices if component is self.surface else component.vertex_index[vertices])


def form_map(
    surface: Surface,
    structure: AnyStructure,
    why: str = "it was asked for",
    *,
    evenness: float = 0.0,
    progress: Progress | None = None,
) -> Map:
    """The `Map` of the balanced combination of a structure's forms.

    surface : the connected part, whose polygon corners are those that were solved on
    evenness : from 0 for a conformal map to 1 for squares of nearly one size, which are sheared instead. Jumps stay,
        and so do straight and round boundaries
    progress : as in `conformal_structure`

    Raises ValueError for an evenness outside 0 to 1; SolverError; Cancelled.
    Source: Gu, Wang, Yau (2003), § 7, for combinations; evening is ours, docs/method/evening.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(holomorph.form_map(surface, structure).kind)
    forms
    """
    evenness = checked_evenness(evenness)
    check_type(why, str, "why")
    asked = {"coefficients": None, "evenness": evenness, "is_upright": False, "why": why}
    made = _native.form_map(structure._core, **asked, threads=structure._threads, progress=progress)
    return Map.of_core(made, surface, structure)
