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
from ..core.progress import scaled
from ..core.value import Value
from ..mesh.checks import check_threads, check_type, checked_evenness, only_component
from ..mesh.hard_edges import folds
from ..mesh.surface import Surface
from ..quality.appearance import CONE, HARD_SEAM, POLE, SEAM, cost
from ..quality.distortion import WorstPlace, drawn_density, worst_places
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, verdict
from ..tiles.tiled_surface import TiledSurface
from ..tiling.request import part_of
from ..tiling.tiling import Tiling, vertices_of
from .automatic_structure import AnyStructure
from .late_structure import LateStructure

# Times the root of its own area that a map is wide: single precision has no room for others then.
SCATTERED = _native.scattered


@dataclass(frozen=True, eq=False, repr=False)
class Map(Value):
    """Result of `automatic_map`. All arrays are read-only; vertices are those of `surface`.

    surface : Surface, connected
    structure : the conformal structure that the map is made of, or beside
    kind : what the map is

        "tiling" : without visible seams under a texture that tiles
        "forms" : a combination of holomorphic forms, cut along seams
        "strip" : an annulus as a rectangle whose two other sides are a seam
        "log" : around poles, which lie at infinity, also a sphere as a strip
        "disk", "rectangle" : a disk with a round or straight boundary
        "flat" : in one piece, with a free boundary
        "islands" : in flat pieces, one unit of length on the surface a UV unit
        "mixed" : in pieces between hard edges, some of them tilings, the rest flat
    uv : (#C, 2) UVs. Those of a tiling may be multiplied and moved by integers only
    quality : `Quality`; of a map in pieces with the triangles of one piece after those of another
    evenness : from 0, conformal, to 1: how far squares of one size were preferred to angles
    why : why it is this map, in one sentence
    seams : (#S, 2) vertices of the edges where the UVs jump
    soft_length, hard_length : of the seams across the smooth, and along hard edges that hide them, over the square root
        of the surface's area; 0 of a tiling
    islands : how many flat islands lie beside each other; 0 for other kinds
    tilings : the `Tiling`, or those of the pieces that have one, each with the UVs of its own corners
    coefficients : (n,) with which `structure.uv` gives the map; (0,) for a map of another kind
    """

    surface: Surface
    structure: AnyStructure
    kind: str
    uv: Reals
    quality: Quality
    evenness: float
    why: str
    seams: Integers
    soft_length: float
    hard_length: float
    islands: int
    tilings: tuple[Tiling, ...]
    coefficients: Complexes | Reals

    @classmethod
    def of_core(cls, made: _native.Map, surface: Surface, structure: AnyStructure) -> Map:
        """The one that the core made of a connected surface, with its structure for Python."""
        kind, tilings = made.kind, tuple(Tiling.of_core(each, surface) for each in made.tilings)
        is_flat = kind == "islands" and made.islands == 1 and not len(made.seams)
        triangulation = structure._triangulation if kind == "forms" else None if kind == "mixed" else surface._native
        whole = kind == "tiling"
        coefficients = made.coefficients.ravel()
        if kind == "forms" and structure.coefficient_type is np.float64:
            coefficients = coefficients.real.copy()
        return cls(
            surface,
            structure,
            structure.map_kind if kind == "forms" else "flat" if is_flat else kind,
            tilings[0].uv if whole else made.uv,
            tilings[0].quality if whole else Quality._of(made.quality, triangulation, surface.up),
            made.evenness,
            made.why,
            tilings[0].seams if whole else vertices_of(surface, made.seams),
            made.soft_length,
            made.hard_length,
            made.islands,
            tilings,
            arrays.frozen(coefficients),
        )

    @property
    def tiling(self) -> Tiling | None:
        """The tiling of the whole; None for another kind."""
        return self.tilings[0] if self.kind == "tiling" else None

    @property
    def is_tiled(self) -> bool:
        """Whether a texture breaks off when the UVs are moved by anything but whole tiles."""
        return bool(self.tilings)

    @property
    def cost(self) -> float:
        """The cost to the eye, see `appearance.cost`; infinite for a map that is `SCATTERED`."""
        size = np.ptp(self.uv, axis=0).max() if len(self.uv) else 0.0
        if size > SCATTERED * math.sqrt(self.density * self.surface.area):
            return math.inf
        return cost(self.quality, len(self.poles), self.soft_length, self.hard_length, len(self.cones))

    @cached_property
    def seen(self) -> Seen:
        """What is seen of it besides its squares."""
        soft, hard = self.soft_length, self.hard_length
        poles, cones = len(self.poles), len(self.cones)
        costs = SEAM * soft + HARD_SEAM * hard + POLE * poles + CONE * cones
        native = self.surface._native
        folded = 0.0
        if self.surface.vertices is not None and self.surface.area > 0:
            folded = float(native.edge_lengths[folds(self.surface)].sum()) / math.sqrt(self.surface.area)
        lines = next((made.lines for made in self.tilings), "none")
        return Seen(costs, soft, hard, poles if self.is_tiled or poles else None, self.turns, cones, lines, folded)

    @property
    def verdict(self) -> Verdict:
        """The `Verdict` on the map."""
        return verdict(self.quality, self.seen)

    @cached_property
    def poles(self) -> Integers:
        """(k,) vertices around which the UVs change by a residue."""
        if self.is_tiled:
            return arrays.frozen(np.concatenate([made.poles for made in self.tilings]))
        found = self.structure._native.poles() if self.kind == "log" else np.empty(0, np.int32)
        return arrays.frozen(vertices_of(self.surface, found))

    @property
    def turns(self) -> int:
        """2, 4 or 6 where the UVs may turn by this part of a full turn across a seam, see `Tiling.turns`; else 1."""
        return max((made.turns for made in self.tilings), default=1)

    @property
    def cones(self) -> Integers:
        """(k,) vertices with another angle around them than elsewhere, of all tilings that turn."""
        return arrays.frozen(np.concatenate([np.empty(0, np.int64), *(made.cones for made in self.tilings)]))

    @property
    def cone_angles(self) -> Reals:
        """(k,) the angles around `cones` in full turns: 3/4 where three squares meet."""
        return arrays.frozen(np.concatenate([np.empty(0), *(made.cone_angles for made in self.tilings)]))

    @property
    def jumps(self) -> Integers:
        """(k, 3) turns and translations of the UVs, see `Tiling.jumps`: across `seams` of a tiling that turns; of a map
        in pieces across the seams of those of its tilings that do, one after the other."""
        return arrays.frozen(np.concatenate([np.empty((0, 3), np.int64), *(made.jumps for made in self.tilings)]))

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
        return replace(
            self,
            surface=surface,
            structure=structure or self.structure.of_copy(surface),
            quality=self.quality.of_copy(scale),
            tilings=tuple(replace(made, quality=made.quality.of_copy(scale)) for made in self.tilings),
        )

    def _facts(self):
        return [self.kind, self.why, self.verdict.level]


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
    asked = {"evenness": evenness, "is_upright": False, "why": why}
    made = _native.form_map(structure._core, **asked, threads=structure._threads, progress=progress)
    return Map.of_core(made, surface, structure)


def island_map(
    surface: Surface, *, evenness: float = 0.0, threads: int = 0, progress: Progress | None = None
) -> Map | None:
    """The `Map` of a connected surface in flat islands; None where a piece cannot be flattened, as where it is closed.

    The surface is cut along edges where it breaks off by more than 60 degrees, a bevel once, and by more than 40 and
    30 where pieces stretch or lie over themselves, whichever looks best; from tips to these edges, and until all pieces
    are disks but for small holes. Each is mapped with a free boundary and evened; where lengths change by more
    than a factor of 2.5, it is cut open to its cone points too if that looks better, and parted where it lies over
    itself. Pieces are turned upright, and those that fit edge to edge are joined: first those that stay upright, longer
    edges first.

    Parameters
    ----------
    surface : Surface with positions
    evenness : as in `Structure.tile`
    threads, progress : as in `conformal_structure`

    Raises TopologyError for several components, and for a surface without positions; Cancelled.
    Source: Sawhney & Crane (2017), section 4, for each piece; cuts and joints are ours, docs/choice.md.

    Examples
    --------
    >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = holomorph.Surface(corners, sides)
    >>> found = holomorph.island_map(cube)
    >>> print(found.islands, len(found.seams))
    1 7
    """
    check_type(surface, Surface)
    component = only_component(surface)
    if surface.vertices is None:
        raise TopologyError("islands need a surface with positions; this one has edge lengths only")
    threads = check_threads(threads or None)
    asked = {"evenness": checked_evenness(evenness), "threads": threads, "progress": scaled(progress, 0.0, 0.0)}
    made = _native.island_map(part_of(surface, component), **asked)
    return made and Map.of_core(made, surface, LateStructure(surface, surface, threads))
