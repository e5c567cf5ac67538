"""Making tilings: poles are placed, and tilings with them made, evened and changed."""

from __future__ import annotations

import math
import weakref
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Progress
from ..core.value import counted, quoted
from ..mesh.checks import SOLVERS, check_name, check_threads, checked_evenness, only_component, real_number
from ..mesh.surface import Surface
from ..quality.quality import Quality
from .tilings import (
    PlacedPoles,
    Poles,
    Rounding,
    Tiling,
    along,
    asked_poles,
    generators,
    is_straight,
    own_allowed,
    own_poles,
)


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
        self._surface, self._component, self._threads = surface, only_component(surface), check_threads(threads or None)
        check_name(solver, SOLVERS, "solver")
        count, chosen = asked_poles(poles)
        vertices, labels = own_poles(surface, self._component, chosen)
        self._placement = _native.place_poles(
            self._component._native,
            count=count,
            vertices=vertices,
            allowed=own_allowed(allowed, surface, self._component),
            straight=is_straight(boundary, self._component, evened),
            labels=labels,
            evened=evened,
            solver=solver,
            like=like and like._placement,
            threads=self._threads,
            progress=progress,
        )
        self._made = weakref.WeakKeyDictionary()  # in the core, by the `Tiling` that stands for it

    def __repr__(self) -> str:
        return f"<Tiler: {counted(len(self.poles.vertices), 'pole')} on {self._surface!r}>"

    def __reduce__(self):
        raise TypeError("a Tiler is neither copied nor pickled: take its tiling, or its surface and poles")

    @property
    def poles(self) -> PlacedPoles:
        """`PlacedPoles`."""
        placement = self._placement
        vertices, size_range = self._of_surface(placement.poles()), math.sqrt(placement.density_ratio)
        return PlacedPoles(vertices, placement.residues(), size_range)

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
        size_counts: bool = False,
        progress: Progress | None = None,
    ) -> Tiling:
        """A `Tiling`; see `Structure.tile`. turn : radians by which the texture is rotated, beside the direction."""
        if max_added is not None and real_number(max_added, "max_added") < 1:
            raise ValueError(f"max_added is {quoted(max_added)}; an angle distortion of at least 1 is needed")
        tiles = 0.0 if tiles is None else real_number(tiles, "tiles", positive=True)
        turn = None if turn is None else real_number(turn, "turn")
        max_turn = real_number(max_turn, "max_turn")
        vector, turn = along(direction, turn, self._component)
        evenness = checked_evenness(evenness)
        made = self._tiling(
            _native.tile(
                self._placement,
                tiles=tiles,
                lattice=generators(lattice),
                turn=turn,
                direction=vector,
                max_turn=max_turn,
                evenness=evenness,
                size_counts=size_counts,
                threads=self._threads,
                progress=progress,
            ),
            evenness,
            isinstance(direction, str),
        )
        if max_added is not None and made.added_distortion > max_added:
            raise TopologyError(_too_sheared(made, max_added, self._surface.genus))
        return made

    def even(self, tiling: Tiling, evenness: float, *, progress: Progress | None = None) -> Tiling:
        """A tiling of this `Tiler` with another evenness. Nothing is placed or rounded again: quick."""
        made = self._own(tiling)
        evenness = checked_evenness(evenness)
        evened = _native.evened_tiling(made, evenness=evenness, threads=self._threads, progress=progress)
        return self._tiling(evened, evenness, tiling.quality.direction is not None)

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
        evenness = tiling.evenness if evenness is None else checked_evenness(evenness)
        if not isinstance(moves, Mapping):
            raise ValueError(f"moves is {quoted(moves)}; a dictionary from poles to vertices is needed")
        own, _ = own_poles(self._surface, self._component, list(moves.values()))
        moved = _native.move_poles(
            self._placement,
            made,
            list(zip(moves, own)),
            evenness=evenness,
            threads=self._threads,
            progress=progress,
        )
        return self._tiling(moved, evenness, tiling.quality.direction is not None)

    def _own(self, tiling):
        if tiling not in self._made:
            raise ValueError("this Tiler did not make the tiling")
        return self._made[tiling]

    def _tiling(self, made, evenness, is_upright):
        uv, triangulation, zeros = made.uv(), made.surface(), made.zeros()
        up = self._component.up if is_upright and not triangulation.intrinsic else None
        found = _native.quality_of_tiling(made, up=up, threads=self._threads)
        basis, jumps = (np.array([z.real, z.imag]) for z in (made.lattice(), made.periods().ravel()))
        periods = np.linalg.solve(basis, jumps)
        tiling = Tiling(
            uv=uv,
            periods=arrays.frozen(np.rint(periods.T).astype(np.int64).reshape(-1, 2)),
            poles=self._of_surface(made.poles()),
            residues=made.residues(),
            zeros=(self._of_surface(zeros.vertices), zeros.orders),
            evenness=evenness,
            added_distortion=made.distortion(),
            beltrami_rms=made.beltrami_rms(),
            optimal_size_range=self.poles.size_range,
            rounding=Rounding(*made.rounding()),
            tiles=made.tiles(),
            quality=Quality._of(found, triangulation, self._component.up),
            seams=self._of_surface(triangulation.edges[made.seams()]),
            lattice=arrays.frozen(basis.copy()),
        )
        self._made[tiling] = made
        return tiling

    def _of_surface(self, vertices):
        same = self._component is self._surface
        return vertices if same else arrays.frozen(self._component.vertex_index[vertices])


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


def _too_sheared(made, max_added, genus):
    """The sentence of the refusal, with what can be had instead."""
    poles = counted(len(made.poles), "pole")
    advice = "take more tiles" if len(made.poles) >= genus else f"take {genus} poles or more, or more tiles"
    return (
        f"with {poles} and {made.tiles:.4g} tiles the added distortion is {made.added_distortion:.5g}, more than "
        f"max_added, {max_added:.5g}: {advice}"
    )
