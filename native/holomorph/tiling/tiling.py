"""Seamless tilings: UV maps of even density whose jumps are symmetries of the texture; poles, and tilings with them."""

from __future__ import annotations

import math
import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import Value, counted
from ..mesh.checks import SOLVERS, check_name, check_threads, checked_evenness, only_component
from ..mesh.surface import Surface
from ..quality.appearance import CONE, POLE
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, special, verdict
from .request import Poles, Request, part_of


@dataclass(frozen=True, repr=False)
class Rounding(Value):
    """How the whole numbers of a tiling were found.

    integers : how many there are, for periods and residues
    blocks : 1 where their lattice was reduced as a whole; else the number of parts, reduced one by one, as a whole
        took too long
    steps : of the reductions
    excess : how much further from the map without rounding one is than in a lattice of orthogonal vectors, which would
        be 1: root mean square over geometric mean of the reduced basis's orthogonal lengths
    """

    integers: int
    blocks: int
    steps: int
    excess: float

    def _facts(self):
        return [counted(self.integers, "integer"), counted(self.blocks, "block"), f"excess {self.excess:.4g}"]


@dataclass(frozen=True, eq=False, repr=False)
class Tiling(Value):
    """Result of `tile`. All arrays are read-only.

    uv : (#C, 2) UVs: one tile of the texture is the unit square. Multiply them by integers only, and move them by
        integers only: else seams show. Rounded to single precision, the two sides of a cut still differ by whole tiles
    periods : (2g + b - 1, 2) integers: the jumps of (u, v) along the loops of a homology basis, in vectors of the
        lattice
    poles : (k,) vertices around which the texture closes up only by whole tiles; the density grows towards them
    residues : (k,) complex points of the lattice: by how much the UVs change around each pole, counter-clockwise
    zeros : ((k,) vertices, (k,) orders): where the texture branches, around 2 pi (order + 1)
    evenness : from 0, conformal, to 1: how far squares of one size were preferred to angles
    added_distortion : angle distortion that the rounding to integers alone would give; 1 where it costs none. Of a
        tiling that turns, that of the map before it was evened; flipped triangles count with 10
    beltrami_rms : root mean square of the Beltrami coefficient of the rounding; flipped triangles of a tiling that
        turns count with 1
    optimal_size_range : the `size_range` that these poles allow without integers
    rounding : `Rounding`
    tiles : the number of tiles that was aimed at: area times median density
    quality : `Quality` on the triangles of the surface, diagonals flipped away from the poles
    seams : (#S, 2) vertices of the edges where the UVs jump
    lattice : (2, 2) reals, whose columns are the translations by which they may
    turns : 1 where all jumps are translations; else 2, 4 or 6: they may also turn by a half, a quarter or a sixth
    cones : (k,) vertices around which a tiling that turns has another angle than elsewhere
    cone_angles : (k,) these, in full turns: 3/4 where three squares meet
    jumps : (#S, 3) integers, of a tiling that turns: from the triangle on the left of a seam to that on its right the
        UVs are turned so many times, and moved by so much, in vectors of the lattice
    lines : "free" where rows run along hard edges and smooth boundaries, "whole" where they end there, too;
        "mirror" where both halves of a surface that mirrors itself are alike; "none"
    """

    uv: Reals
    periods: Integers
    poles: Integers
    residues: Complexes
    zeros: tuple[Integers, Integers]
    evenness: float
    added_distortion: float
    beltrami_rms: float
    optimal_size_range: float
    rounding: Rounding
    tiles: float
    quality: Quality
    seams: Integers
    lattice: Reals
    turns: int = 1
    cones: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    cone_angles: Reals = field(default_factory=lambda: np.empty(0))
    jumps: Integers = field(default_factory=lambda: np.empty((0, 3), np.int64))
    lines: str = "none"

    @classmethod
    def of_core(cls, made: _native.SeamlessMap, surface: Surface) -> Tiling:
        """The one that the core made of a connected surface."""
        values = {one.name: getattr(made, one.name) for one in fields(cls)}
        values |= {name: vertices_of(surface, values[name]) for name in ("poles", "seams", "cones")}
        values["zeros"] = vertices_of(surface, made.zeros[0]), made.zeros[1]
        values["quality"] = Quality._of(made.quality, made.triangulation, surface.up)
        values["lattice"] = arrays.frozen(np.array([[z.real, z.imag] for z in made.lattice]).T.copy())
        return cls(**values | {"rounding": Rounding(*made.rounding)})

    def _facts(self):
        size = f"{self.tiles:.4g} tiles, {special(len(self.poles), self.turns, len(self.cones), self.lines)}"
        return [size, f"size range {self.size_range:.4g}", f"angle distortion {self.quality.mean_angle:.4g}"]

    @property
    def size_range(self) -> float:
        """`Quality.size_range`."""
        return self.quality.size_range

    @property
    def verdict(self) -> Verdict:
        """The `Verdict` on the map."""
        return verdict(self.quality, self.seen)

    @property
    def seen(self) -> Seen:
        """What is seen of it besides its squares."""
        poles, cones = len(self.poles), len(self.cones)
        return Seen(POLE * poles + CONE * cones, 0.0, 0.0, poles, self.turns, cones, self.lines)


@dataclass(frozen=True, repr=False)
class PlacedPoles(Value):
    """Vertices, complex residues up to a common factor, and the size range that they allow."""

    vertices: Integers
    residues: Complexes
    size_range: float

    def _facts(self):
        return [counted(len(self.vertices), "pole"), f"size range {self.size_range:.4g}"]


def vertices_of(surface, own):
    """Vertices of the one component of a surface as those of the surface, which may have isolated ones besides."""
    component = surface.components[0]
    return own if component is surface else arrays.frozen(component.vertex_index[own])


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
