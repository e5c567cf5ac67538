"""Tilings whose sides of a cut may also turn, by the symmetry of the texture: cones take the place of poles."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Integers, Progress
from ..core.value import quoted
from ..mesh.checks import check_threads, checked_evenness, only_component, own_vertices, real_number
from ..mesh.edges import boundary_edges
from ..mesh.origin import edges_on_part
from ..mesh.surface import Surface
from ..quality.quality import Quality
from .image_turns import image_turns
from .tilings import LATTICES, UPRIGHT, Rounding, Tiling, along

TURNS = (1, 2, 4, 6)
AUTO = "auto"  # those of the texture
LATTICE = {2: "square", 4: "square", 6: "hex"}  # of which a turn by this part of a full one is a symmetry
LINED_TURNS = (2, 4)  # lines cross at right angles
WHOLE = 1e-6  # part of a turn: less is rounding
MOST_PARTS = 1200  # of a turn around one cone: all that any use has, and no sum of them overflows
EDGED, MIRROR = ("whole", "free"), "mirror"  # lines along edges, and the one between two halves that are alike
LINES = ("none", *EDGED, MIRROR)
NO_EDGES = np.empty((0, 2), np.int32)
AUTOMATIC = "automatic"  # the lines that cost little


class TurnedTiler:
    """Makes turned tilings of a surface. Their cones are searched for by the first one, and kept for others with about
    as many tiles.

    Parameters
    ----------
    surface : Surface with positions, connected
    turns : 2, 4 or 6: the texture looks the same after a half, a quarter or a sixth turn
    direction : "upright" for rows that run level; a (3,) vector that u runs along, as far as it can; None for any
    lines : "free" where rows are to run along long hard edges and smooth boundaries; "whole" where they are to end
        there as well; "mirror" where both halves of a surface that mirrors itself are to look alike; "none"
    marked : (n, 2) vertices of edges that are to be lines besides those of `lines_of`
    cones : {vertex: angle in full turns} instead of those that are searched for
    threads : as in `conformal_structure`

    Raises TopologyError for a surface without positions, and for cones that it cannot have.
    """

    def __init__(
        self,
        surface: Surface,
        turns: int,
        *,
        direction: ArrayLike | str | None = UPRIGHT,
        lines: str = "none",
        marked: ArrayLike | None = None,
        cones: Mapping[int, float] | None = None,
        threads: int | None = 0,
    ) -> None:
        self._surface, self._component, self._threads = surface, only_component(surface), check_threads(threads or None)
        vector, _ = along(direction, None, self._component)
        self._turns, self._rows = turns, lines
        own = self._own_edges(marked)
        self._native = _native.TurnedTiler(
            self._component._native,
            turns=turns,
            direction=vector,
            is_of_u=not isinstance(direction, str),
            up=self._component.up,
            lines=lines,
            marked=NO_EDGES if own is None else own,
            chosen=[] if cones is None else self._missing(cones),
        )

    def tile(self, tiles: float | None = None, *, evenness: float = 0.0, progress: Progress | None = None) -> Tiling:
        """A `Tiling` with about this number of tiles; default: one that suits the genus. Raises
        TopologyError where most of the surface would collapse; SolverError, Cancelled."""
        evenness = checked_evenness(evenness)
        tiles = self._native.usual_tiles() if tiles is None else real_number(tiles, "tiles", positive=True)
        made = self._native.tile(tiles, evenness=evenness, threads=self._threads, progress=progress)
        jumps, missing, native = made.jumps(), made.missing(), self._component._native
        return Tiling(
            uv=made.uv(),
            periods=arrays.frozen(np.empty((0, 2), np.int64)),
            poles=arrays.frozen(np.empty(0, np.int64)),
            residues=arrays.frozen(np.empty(0, complex)),
            zeros=(arrays.frozen(np.empty(0, np.int64)), arrays.frozen(np.empty(0, np.int64))),
            evenness=evenness,
            added_distortion=1.0,
            beltrami_rms=0.0,
            optimal_size_range=1.0,
            rounding=Rounding(2 * len(missing), 1, 0, 1.0),
            tiles=tiles,
            quality=Quality._of(made.quality, native, self._component.up),
            seams=self._of_surface(native.edges[jumps[:, 0]]),
            lattice=arrays.frozen(np.array([[z.real, z.imag] for z in LATTICES[LATTICE[self._turns]]]).T.astype(float)),
            turns=self._turns,
            cones=self._of_surface(made.cones()),
            cone_angles=arrays.frozen(1 - missing / self._turns),
            jumps=arrays.frozen(jumps[:, 1:]),
            lines=self._rows if made.has_lines() else "none",
        )

    def _missing(self, cones):
        """(#V,) k-th turns that are missing around the vertices of the component."""
        vertices, _ = own_vertices(self._surface, self._component, list(cones), "cone")
        angles = [real_number(angle, "the angle around a cone", positive=True) for angle in cones.values()]
        parts = np.rint(np.multiply(angles, self._turns))
        off = np.abs(np.multiply(angles, self._turns) - parts)
        wrong = np.flatnonzero((off > WHOLE) | (parts < 1) | (parts > MOST_PARTS))
        if len(wrong):
            wanted = f"{self._turns}, whole parts of a turn, up to {MOST_PARTS // self._turns}"
            raise ValueError(
                f"the angle around a cone is {angles[wrong[0]]:.6g} turns; multiples of 1/{wanted}, are needed"
            )
        missing = np.zeros(len(self._component.vertices), np.int64)
        missing[vertices] = self._turns - parts.astype(np.int64)
        edge = np.flatnonzero(np.isin(vertices, boundary_edges(self._component)))
        if len(edge):
            raise TopologyError(f"vertex {list(cones)[edge[0]]} is on the boundary, where no cone can be")
        return missing

    def _own_edges(self, ends):
        if ends is None:
            return None
        ends = arrays.integer(ends, "marked", 2, (2,))
        return ends if self._component is self._surface else edges_on_part(self._component, ends)

    def _of_surface(self, vertices):
        same = self._component is self._surface
        return arrays.frozen(vertices if same else self._component.vertex_index[vertices])


def lines_of(surface: Surface, marked: ArrayLike | None = None) -> Integers:
    """The edges that lines of the lattice run along: long chains of hard edges, and smooth boundaries, ascending.

    marked : (n, 2) vertices of the surface: edges that are lines in any case, unless they are most of the mesh's
    """
    return _native.found_lines(surface._native, NO_EDGES if marked is None else marked)


def are_whole(ends: Integers) -> bool:
    """Whether few chains end, of edges with these (n, 2) vertices."""
    return _native.are_whole(ends)


def checked_lines(lines: Any, turns: int, *others: str) -> str:
    """Raises ValueError for anything but `LINES` and these others, and for lines of a tiling that turns by other than
    quarters or halves."""
    names = (*others, *LINES)
    if not isinstance(lines, str) or lines not in names:
        raise ValueError(f"lines is {quoted(lines)}; one of {', '.join(names)} is needed")
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


def check_cones(cones: Any, turns: int, lines: str) -> None:
    """Raises ValueError for chosen cones of a tiling that has none, or whose lines say where they are."""
    if cones is not None and (turns == 1 or lines != "none"):
        raise ValueError("cones can be chosen for tilings that turn by 2, 4 or 6 and have no lines")


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


def check_fits(options: dict[str, Any]) -> None:
    """Raises ValueError for options that a turned tiling does not have.

    options : by name, the value and those that fit
    """
    for name, (given, *fitting) in options.items():
        if isinstance(given, np.ndarray) or given not in (*fitting, None):
            raise ValueError(f"{name} is {quoted(given)}; a tiling that turns has no such choice: take turns=1")
