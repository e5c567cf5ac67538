"""Making tilings: poles are placed, and tilings with them made, evened and changed."""

from __future__ import annotations

import math
import weakref
from collections.abc import Mapping

from numpy.typing import ArrayLike

from .. import _native
from ..core.array_types import Progress
from ..core.value import counted
from ..mesh.checks import SOLVERS, check_name, check_threads, checked_evenness, only_component
from ..mesh.surface import Surface
from .request import Request, part_of
from .tilings import PlacedPoles, Poles, Tiling, vertices_of


class Tiler:
    """The poles of a surface and what tilings with them are made of; changing tiles, lattice or direction is quick.
    It is immutable: several threads, and a progress function, may use it at once.

    Parameters
    ----------
    surface : Surface, connected
    poles : "auto" for as many as the density asks for, a number, or a list of vertices, which stay where they are
    boundary : "straight" for boundary loops along lines of constant v, "free" for a more even density; "automatic" for
        straight ones, but where a face has three corners in a row on one, which evening opens on a free one alone. A
        surface with both handles and a boundary has straight ones in any case
    allowed : (#V,) bool, where poles may be that are not chosen; default anywhere
    evened : whether tilings will be evened: fewer poles are enough then
    like : another Tiler of the surface: what both need is made once
    solver, threads, progress : as in `conformal_structure`
    """

    def __init__(
        self,
        surface: Surface,
        poles: Poles = "auto",
        *,
        boundary: str = "automatic",
        allowed: ArrayLike | None = None,
        evened: bool = False,
        solver: str = "auto",
        like: Tiler | None = None,
        threads: int | None = 0,
        progress: Progress | None = None,
    ) -> None:
        check_name(solver, SOLVERS, "solver")
        component, threads = only_component(surface), check_threads(threads or None)
        asked = Request(poles=poles, boundary=boundary, allowed=allowed).tiling(surface)
        options = {"evened": evened, "solver": solver, "like": like and like._core}
        core = _native.Tiler(part_of(surface, component), asked, **options, threads=threads, progress=progress)
        self._adopt(surface, core, threads)

    @classmethod
    def of_core(cls, surface: Surface, core: _native.Tiler, threads: int) -> Tiler:
        """The one of the core."""
        tiler = cls.__new__(cls)
        tiler._adopt(surface, core, threads)
        return tiler

    def _adopt(self, surface, core, threads):
        self._surface, self._core, self._threads = surface, core, threads
        self._made = weakref.WeakKeyDictionary()  # in the core, by the `Tiling` that stands for it

    def __repr__(self) -> str:
        return f"<Tiler: {counted(len(self.poles.vertices), 'pole')} on {self._surface!r}>"

    def __reduce__(self):
        raise TypeError("a Tiler is neither copied nor pickled: take its tiling, or its surface and poles")

    @property
    def poles(self) -> PlacedPoles:
        """`PlacedPoles`."""
        vertices = vertices_of(self._surface, self._core.poles())
        return PlacedPoles(vertices, self._core.residues(), math.sqrt(self._core.density_ratio()))

    def tile(
        self,
        tiles: float | None = None,
        *,
        lattice: str | ArrayLike = "square",
        direction: ArrayLike | str | None = "upright",
        turn: float | None = None,
        max_turn: float = 0.2,
        max_added: float | None = None,
        evenness: float = 0.0,
        progress: Progress | None = None,
    ) -> Tiling:
        """A `Tiling`; see `Structure.tile`. turn : radians by which the texture is rotated, beside the direction."""
        rounded = {"lattice": lattice, "direction": direction, "turn": turn, "max_turn": max_turn}
        asked = Request(tiles=tiles, max_added=max_added, evenness=evenness, **rounded)
        return self._tiling(self._core.tile(asked.tiling(self._surface), threads=self._threads, progress=progress))

    def even(self, tiling: Tiling, evenness: float, *, progress: Progress | None = None) -> Tiling:
        """A tiling of this `Tiler` with another evenness. Nothing is placed or rounded again: quick."""
        made, evenness = self._own(tiling), checked_evenness(evenness)
        return self._tiling(self._core.evened(made, evenness, threads=self._threads, progress=progress))

    def move_poles(
        self,
        tiling: Tiling,
        moves: Mapping[int, int],
        *,
        evenness: float | None = None,
        progress: Progress | None = None,
    ) -> Tiling:
        """A tiling of this `Tiler` with some of its poles elsewhere.

        The residues stay, and so do the periods but where a pole has a shorter way to its place around a handle.
        Nothing is rounded again. On a surface with handles the other poles move until the form is holomorphic again, as
        far as they can: where they were chosen they stay, and `added_distortion` grows.

        moves : {index in `Tiling.poles`: vertex}
        evenness : default that of the tiling
        """
        made = self._own(tiling)
        asked = Request(evenness=tiling.evenness if evenness is None else evenness, moves=moves)
        return self._tiling(
            self._core.moved(made, asked.tiling(self._surface), threads=self._threads, progress=progress)
        )

    def _own(self, tiling):
        if tiling not in self._made:
            raise ValueError("this Tiler did not make the tiling")
        return self._made[tiling]

    def _tiling(self, made):
        tiling = Tiling.of_core(made, self._surface)
        self._made[tiling] = made
        return tiling


def place_poles(
    surface: Surface,
    count: Poles = "auto",
    *,
    allowed: ArrayLike | None = None,
    progress: Progress | None = None,
) -> PlacedPoles:
    """`PlacedPoles` of a connected surface: where poles make the texture density most even. Arguments as in `Tiler`.

    A greedy start, then moves of one pole at a time, poles taken away and added anew where they do best, and a few more
    than asked for of which those stay that matter, on a level of the progressive mesh of about 10,000 triangles.
    Deterministic.

    Raises what `Tiler` raises: TopologyError for poles that do not fit, ValueError for other arguments; SolverError;
    Cancelled.
    Source: ours, docs/method/poles.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> print(len(holomorph.place_poles(surface, 4).vertices))
    4
    """
    return Tiler(surface, count, allowed=allowed, progress=progress).poles
