"""The UV map of one connected part, of whichever kind; and those of all parts of several objects, with squares of one
size. The core chooses: native/src/choice."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np

from .. import _native
from .._native import InvalidMesh, SolverError, TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import Value
from ..mesh.checks import check_threads
from ..mesh.hard_edges import folds
from ..mesh.surface import Surface
from ..quality.appearance import CONE, HARD_SEAM, POLE, SEAM, cost
from ..quality.distortion import WorstPlace, drawn_density, worst_places
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, verdict
from ..tiles.tiled_surface import TiledSurface
from ..tiling.request import Request, Size, plain_size
from ..tiling.tiling import Tiling, vertices_of
from .automatic_structure import AnyStructure, LateStructure, structure_of

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


REFUSALS = InvalidMesh, TopologyError, SolverError  # what is said about one part, others go on
Refusal: TypeAlias = InvalidMesh | TopologyError | SolverError
Made: TypeAlias = Map | Refusal | MemoryError
Asked: TypeAlias = tuple[Request, Surface, AnyStructure | LateStructure | None]  # of a part, in its own vertices


class MappedParts(NamedTuple):
    """maps : of the parts of one object; size : with which that object alone gets the same maps"""

    maps: list[Made]
    size: Size


def map_objects(
    objects: Sequence[Sequence[Asked]],
    size: Size,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[MappedParts]:
    """The maps of the parts of each object, with squares of one size over all of them.

    The median densities of tilings differ by a tenth at most from that of the largest part, which is made first, or by
    up to a fifth where other maps cost more. A part on which whole tiles are too few for that, or have no room, gets
    another map, which `arrangement` scales. Small parts are made side by side, and copies of one part once. What has
    no map, also for want of memory, gets the error.
    """
    threads, kind = check_threads(threads), _native.Request
    asked = [[_or_error(_core, *each) for each in parts] for parts in objects]
    fitting = [[core for core in cores if isinstance(core, kind)] for cores in asked]
    found = _native.map_objects(fitting, _native.SizePolicy(*size), threads=threads, progress=progress)
    pairs = (pair for each in zip(objects, asked) for pair in zip(*each))
    maps, result = _Maps([part for part, core in pairs if isinstance(core, kind)], threads), []
    for cores, (mapped, own_size) in zip(asked, found):
        made = iter(mapped)
        own = [maps.of(next(made)) if isinstance(core, kind) else core for core in cores]
        result.append(MappedParts(own, plain_size(own_size)))
    return result


def _core(request, surface, structure):
    """The core's request. Where a structure is not solved for yet, other maps than of forms may do."""
    if isinstance(structure, LateStructure):
        is_needed = request.main in ("seamless", "balanced") or not isinstance(request.poles, str)
        structure = structure.made if is_needed else None
    return request.core(surface, structure)


def _or_error(work, *arguments):
    """What a function returns, or what refuses one part: others go on."""
    try:
        return work(*arguments)
    except (*REFUSALS, MemoryError) as error:
        return error.with_traceback(None)  # which holds what took the memory


class _Maps:
    """The maps of the core as those of Python. A map that copies share is converted once."""

    def __init__(self, parts, threads):
        self._parts, self._threads, self._next = parts, threads, 0
        self._structures: dict[int, AnyStructure | LateStructure] = {}
        self._maps: dict[_native.Map, Map] = {}

    def of(self, made):
        """The map of the next part."""
        (_, surface, structure), is_first = self._parts[self._next], made.first == self._next
        self._next += 1
        if made.map is None:
            return _or_error(made.raise_refusal)
        if made.map not in self._maps:
            self._maps[made.map] = self._converted(made.map, made.first)
        found = self._maps[made.map]
        return found if is_first else found.of_copy(surface, structure, made.scale)

    def _converted(self, made, part):
        _, surface, structure = self._parts[part]
        if part not in self._structures:
            self._structures[part] = self._structure(made.structure, surface, structure)
        return Map.of_core(made, surface, self._structures[part])

    def _structure(self, core, surface, given):
        if core is None:  # islands took its place
            return given or LateStructure(surface, surface, self._threads)
        if isinstance(given, LateStructure):
            given = vars(given).get("made")
        return structure_of(core, surface, self._threads) if given is None else given
