"""What is asked of the maps of a mesh, and of a tiling alone."""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Integers
from ..core.value import quoted
from ..mesh.checks import check_list, check_name, checked_evenness, only_component, own_vertices, real_number
from ..mesh.edges import boundary_edges
from ..mesh.origin import edges_on_part, on_part
from ..mesh.surface import Surface
from .images import image_turns

LATTICES = {"square": (1, 1j), "brick": (1, 0.5 + 1j), "hex": (1, 0.5 + 0.5j * math.sqrt(3))}
BOUNDARIES = ("automatic", "straight", "free")
MOST_POLES, MOST_PER_TILE = 1000, 1000
Poles: TypeAlias = str | int | Sequence[int] | Integers  # "auto", a number, or vertices
UPRIGHT = "upright"
MAIN_MAPS = ("automatic", "seamless", "untiled", "balanced")
ISLANDS = "islands"  # between chosen cuts: the main map of those that choose them
EVENNESS = 0.5  # what suits textures: squares hardly differ in size, and their shear is not seen
TOLERANCE = 0.2  # of a density that is given, a tenth of lengths: less is seen of that than of a seam
NO_EDGES = np.empty((0, 2), np.int32)
TURNS = (1, 2, 4, 6)
AUTO = "auto"  # those of the texture
LATTICE = {2: "square", 4: "square", 6: "hex"}  # of which a turn by this part of a full one is a symmetry
LINED_TURNS = (2, 4)  # lines cross at right angles
WHOLE = 1e-6  # part of a turn: less is rounding
MOST_PARTS = 1200  # of a turn around one cone: all that any use has, and no sum of them overflows
LINES = ("none", "whole", "free", "mirror")  # along edges, and the one between two halves that are alike
AUTOMATIC = "automatic"  # the lines that cost little
Moves: TypeAlias = Mapping[int, int] | Sequence[tuple[int, int]]
Size: TypeAlias = tuple[float, int, float | None, tuple[float, float] | None, float]  # values of a `_native.SizePolicy`


@dataclass(frozen=True, eq=False)
class Request:
    """What is asked of all parts of a mesh, as in `automatic_maps`, in vertices of the mesh as given. What
    `Structure.tile` is asked for is one as well, in vertices of its surface.

    size : as `map_objects` found it with other meshes; it counts in place of tiles and density
    moves : index of a pole in the tiling of its part, and the vertex that it is moved to after the rounding
    """

    main: str = "automatic"
    tiles: float | None = None
    density: float | None = None
    size: Size | None = None
    poles: Poles = "auto"
    allowed: ArrayLike | None = None
    moves: Moves = ()
    lattice: str | ArrayLike = "square"
    direction: ArrayLike | str | None = UPRIGHT
    boundary: str = "automatic"
    turn: float | None = None
    max_turn: float = 0.2
    max_added: float | None = None
    turns: int = 1
    lines: str = AUTOMATIC
    marked: ArrayLike | None = None
    cones: Mapping[int, float] | None = None
    evenness: float = EVENNESS
    effort: float = 1.0
    seams: ArrayLike | None = None
    hard_edges: float = 0.0
    most_stretch: float = 0.0

    @property
    def key(self) -> tuple[Any, ...]:
        """Equal where the same is asked."""
        return tuple(_plain(getattr(self, one.name)) for one in fields(self))

    @property
    def is_chosen(self) -> bool:
        """Whether poles, places for them, or a number of tiles are chosen."""
        return bool(self.tiles) or self.has_points or self.allowed is not None or self.poles not in ("auto", 0)

    @property
    def has_points(self) -> bool:
        """Whether vertices are chosen as poles or cones."""
        return bool(self.moves or self.cones) or not isinstance(self.poles, (str, numbers.Real))

    def alone(self, area: float) -> Request:
        """The same of one tiling over this area. Raises ValueError for choices of which it has one or the other; of a
        map the core leaves some out."""
        checked_lines(self.lines, self.turns)
        if self.cones is not None and (self.turns == 1 or self.lines != "none"):
            raise ValueError("cones can be chosen for tilings that turn by 2, 4 or 6 and have no lines")
        lattice = self.lattice if isinstance(self.lattice, str) else None
        if self.turns != 1 and lattice not in ("square", LATTICE.get(self.turns)):
            raise ValueError(f"lattice is {quoted(self.lattice)}; a tiling that turns has no such choice: take turns=1")
        return self if self.density is None else replace(self, tiles=self._density * area, density=None)

    def size_of(self, parts: Sequence[Surface]) -> Size:
        """How large squares are over all of these parts: by a number of tiles over all of them, or per unit of area;
        without either 100 tiles, or 64 for each handle, over the largest part."""
        if self.size:
            return self.size
        if self.density is None:
            tiles = 0.0 if self.tiles is None else real_number(self.tiles, "tiles", positive=True)
            return plain_size(_native.SizePolicy.of_tiles([part_of(part) for part in parts], tiles))
        return plain_size(_native.SizePolicy.of_density(self._density, TOLERANCE))

    @property
    def _density(self):
        if self.tiles is not None:
            raise ValueError("give tiles or a density, not both")
        return real_number(self.density, "density", positive=True)

    def on_part(self, part: Surface) -> Request:
        """What is asked of a part, in its own vertices. One without any of the chosen vertices has automatic ones; one
        on which no pole may be gets none."""
        check_list(self.moves, "moves")
        check_chosen(self.marked, self.cones)
        if not self.has_points and all(each is None for each in (self.allowed, self.marked, self.cones, self.seams)):
            return self
        poles, allowed = self.poles, self.allowed
        if not isinstance(poles, (str, numbers.Real)):
            places, is_there = on_part(part, arrays.integer(poles, "poles"))
            poles = places[is_there].tolist() or "auto"
        if allowed is not None:
            allowed = _flags(allowed, part.given_vertex_count)[part.vertex_index]
            if not allowed.any():
                allowed, poles = None, 0 if isinstance(poles, (str, numbers.Real)) else poles
        places, is_there = on_part(part, arrays.integer([vertex for _, vertex in self.moves], "moves"))
        moves = {pole: int(place) for (pole, _), place, has in zip(self.moves, places, is_there) if has}
        marked, seams = (
            None if ends is None else edges_on_part(part, arrays.integer(ends, name, 2, (2,)))
            for name, ends in (("marked", self.marked), ("seams", self.seams))
        )
        cones = None
        if self.cones:
            places, is_there = on_part(part, arrays.integer(list(self.cones), "cones"))
            cones = {int(v): angle for v, angle, has in zip(places, self.cones.values(), is_there) if has} or None
        return replace(self, poles=poles, allowed=allowed, moves=moves, marked=marked, cones=cones, seams=seams)

    def core(self, surface: Surface, structure: Any = None) -> _native.Request:
        """The core's own, in vertices of this connected surface, whose `Structure` may be known. Raises TopologyError
        and ValueError for choices that do not fit the surface, ValueError and InvalidMesh for those that fit none."""
        check_name(self.main, (*MAIN_MAPS, ISLANDS), "main")
        options = {"main": self.main, "effort": real_number(self.effort, "effort", positive=True)}
        options |= {"evenness": checked_evenness(self.evenness), "lines": self.lines, "tiling": self.tiling(surface)}
        part, core = (structure._part, structure._core) if structure else (part_of(surface), None)
        cuts = {name: real_number(getattr(self, name), name) for name in ("hard_edges", "most_stretch")}
        for name, least in (("hard_edges", 0), ("most_stretch", 1)):
            if cuts[name] != 0 and cuts[name] <= least:
                raise ValueError(f"{name} is {quoted(getattr(self, name))}; a number above {least} is needed, or 0")
        return _native.Request(
            part, core, **options, **cuts, seams=_own_edges(surface, only_component(surface), self.seams, "seams")
        )

    def tiling(self, surface: Surface) -> _native.TileOptions:
        """What is asked of a tiling alone; as `core`."""
        component, options = only_component(surface), {"evenness": checked_evenness(self.evenness)}
        for name in ("tiles", "turn", "max_turn", "max_added"):
            given = getattr(self, name)
            is_open = given is None and name != "max_turn"
            options[name] = None if is_open else real_number(given, name, positive=name == "tiles")
        if self.max_added is not None and self.max_added < 1:
            raise ValueError(f"max_added is {quoted(self.max_added)}; an angle distortion of at least 1 is needed")
        check_name(self.boundary, BOUNDARIES, "boundary")
        check_chosen(self.marked, self.cones)
        lines, missing = checked_lines(self.lines, checked_turns(self.turns), AUTOMATIC), None
        if self.cones is not None:  # of a tiling that does not turn only whether some are chosen counts
            missing = missing_turns(surface, component, self.cones, self.turns).tolist() if self.turns != 1 else []
        if not isinstance(self.moves, Mapping) and self.moves != ():
            raise ValueError(f"moves is {quoted(self.moves)}; a dictionary from poles to vertices is needed")
        lattice, moves = generators(self.lattice), dict(self.moves)
        (count, chosen), (is_upright, vector) = _asked_poles(self.poles), _heading(self.direction)
        return _native.TileOptions(
            **options | {"tiles": options["tiles"] or 0.0},
            count=count,
            poles=_own_poles(surface, component, chosen),
            allowed=_own_allowed(surface, component, self.allowed),
            lattice=lattice,
            is_upright=is_upright,
            direction=vector,
            boundary=self.boundary,
            moves=list(zip(moves, _own_poles(surface, component, list(moves.values())))),
            turns=self.turns,
            lines=lines,
            marked=_own_edges(surface, component, self.marked),
            missing=missing,
        )


def plain_size(size: _native.SizePolicy) -> Size:
    """The values of the core's policy, with which it is made again."""
    return size.density, size.tries, size.tolerance, size.window, size.near


def part_of(surface, component=None):
    """The core's value of the one component of a surface, whose vertices messages name."""
    component = surface.components[0] if component is None else component
    if component is surface:
        return surface._part
    return _native.WholePart(component._native, component.up, component.vertex_index.tolist())


def _plain(value):
    """Can be compared and hashed, where arrays cannot."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    value = sorted(value.items()) if isinstance(value, Mapping) else value
    return tuple(map(_plain, value)) if isinstance(value, (tuple, list)) else value


def _flags(allowed, count):
    allowed = np.asarray(allowed, bool)
    if allowed.shape != (count,):
        raise ValueError(f"allowed has the shape {allowed.shape}; ({count},) is needed")
    return allowed


def _own_allowed(surface, component, allowed):
    """Where poles may be, by the component's vertices; [] for anywhere. @throws ValueError"""
    if allowed is None:
        return []
    own = _flags(allowed, surface._native.vertex_count)
    own = own if component is surface else own[component.vertex_index]
    if not own.any():
        raise ValueError("allowed leaves no vertex for a pole")
    return own.tolist()


def _own_edges(surface, component, ends, name="marked"):
    if ends is None:
        return NO_EDGES
    ends = arrays.integer(ends, name, 2, (2,))
    return ends if component is surface else np.asarray(edges_on_part(component, ends), np.int32)


def _asked_poles(poles):
    """(count or None, chosen vertices). @throws ValueError or InvalidMesh for anything else"""
    if isinstance(poles, str):
        if poles != "auto":
            raise ValueError(f'poles is {quoted(poles)}; "auto", a number or a list of vertices is needed')
        return None, []
    if isinstance(poles, numbers.Real):
        if not 0 <= poles <= MOST_POLES or poles != int(poles):
            raise ValueError(f"poles is {quoted(poles)}; a whole number from 0 to {MOST_POLES} is needed")
        return int(poles), []
    vertices = arrays.integer(poles, "poles")
    return len(vertices), vertices


def _own_poles(surface, component, vertices):
    """The vertices of `own_vertices`; refuses a pole that is given twice."""
    if not len(vertices):
        return []
    own, _ = own_vertices(surface, component, vertices, "pole")
    given, times = np.unique(np.asarray(vertices, int), return_counts=True)
    for vertex in given[times > 1]:
        raise TopologyError(f"pole {vertex} is given twice")
    return own


def _heading(direction):
    """(whether rows run level, (3,) vector that u runs along, or None). @throws ValueError for another direction"""
    if isinstance(direction, str):
        if direction != UPRIGHT:
            raise ValueError(f'direction is {quoted(direction)}; "{UPRIGHT}", three numbers or None is needed')
        return True, None
    if direction is None:
        return False, None
    vector = arrays.numbers(direction, "direction")
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise ValueError(f"direction is {quoted(direction)}; three numbers, not all 0, are needed")
    return False, vector.tolist()


def generators(lattice):
    """The two generators of a lattice as complex numbers. @throws ValueError"""
    if isinstance(lattice, str):
        if lattice not in LATTICES:
            raise ValueError(f"lattice is {quoted(lattice)}; one of {', '.join(LATTICES)} or a 2 x 2 matrix is needed")
        return tuple(complex(z) for z in LATTICES[lattice])
    matrix = arrays.numbers(lattice, "lattice")
    if matrix.shape != (2, 2) or not np.isfinite(matrix).all():
        raise ValueError(f"lattice has the shape {matrix.shape}; a finite 2 x 2 matrix is needed")
    if abs(np.linalg.det(matrix)) <= 1e-9 * np.abs(matrix).max() ** 2:
        raise ValueError("lattice is singular: its columns, the translations of the texture, must be independent")
    return complex(*matrix[:, 0]), complex(*matrix[:, 1])


def missing_turns(surface: Surface, component: Surface, cones: Mapping[int, float], turns: int) -> Integers:
    """(#V,) k-th turns that are missing around the vertices of the component."""
    vertices, _ = own_vertices(surface, component, list(cones), "cone")
    angles = [real_number(angle, "the angle around a cone", positive=True) for angle in cones.values()]
    parts = np.rint(np.multiply(angles, turns))
    off = np.abs(np.multiply(angles, turns) - parts)
    wrong = np.flatnonzero((off > WHOLE) | (parts < 1) | (parts > MOST_PARTS))
    if len(wrong):
        wanted = f"multiples of 1/{turns}, whole parts of a turn, up to {MOST_PARTS // turns}, are needed"
        raise ValueError(f"the angle around a cone is {angles[wrong[0]]:.6g} turns; {wanted}")
    missing = np.zeros(len(component.vertices), np.int64)
    missing[vertices] = turns - parts.astype(np.int64)
    edge = np.flatnonzero(np.isin(vertices, boundary_edges(component)))
    if len(edge):
        raise TopologyError(f"vertex {list(cones)[edge[0]]} is on the boundary, where no cone can be")
    return missing


def checked_lines(lines: Any, turns: int, *others: str) -> str:
    """Raises ValueError for anything but `LINES` and these others, and for lines of a tiling that turns by other than
    quarters or halves."""
    check_name(lines, (*others, *LINES), "lines")
    if lines not in (*others, "none") and turns not in LINED_TURNS:
        raise ValueError(f"lines is {quoted(lines)}, for which turns must be 2 or 4")
    return lines


def check_chosen(marked: Any, cones: Any) -> None:
    """Raises InvalidMesh for marked edges that are no pairs of vertices, ValueError for cones that are no mapping."""
    if marked is not None:
        arrays.integer(marked, "marked", 2, (2,))
    if cones is None:
        return
    if not isinstance(cones, Mapping):
        raise ValueError(f"cones is {quoted(cones)}; a dictionary from vertices to angles in full turns is needed")
    arrays.integer(list(cones), "cones")


def asked_turns(turns: Any, texture: ArrayLike | None) -> int:
    """`checked_turns`, or for `AUTO` those of a texture, of pixels as in `image_turns`; 1 without one."""
    if isinstance(turns, str) and turns == AUTO:
        return 1 if texture is None else image_turns(texture).turns
    return checked_turns(turns)


def checked_turns(turns: Any) -> int:
    """Raises ValueError for anything but 1, 2, 4 or 6."""
    if isinstance(turns, bool) or not isinstance(turns, numbers.Integral) or turns not in TURNS:
        raise ValueError(f"turns is {quoted(turns)}; one of {', '.join(map(str, TURNS))} is needed")
    return int(turns)
