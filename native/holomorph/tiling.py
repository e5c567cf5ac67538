"""Seamless tilings: UV maps whose jumps all are translations of the texture, of even density."""

import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _native, arrays
from ._native import TopologyError
from .array_types import Complexes, Integers, Progress, Reals
from .checks import own_vertices, real_number
from .direction import along
from .quality import Quality
from .surface import Surface
from .value import Value, counted
from .verdicts import Verdict, verdict

LATTICES = {"square": (1, 1j), "brick": (1, 0.5 + 1j), "hex": (1, 0.5 + 0.5j * math.sqrt(3))}
BOUNDARIES = ("straight", "free")
Poles: TypeAlias = str | int | Sequence[int] | Integers  # "auto", a number, or vertices


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
    added_distortion : mean s1 / s2 over the area that the rounding to integers alone would give; 1 where it costs none
    left_over : root mean square of |mu|, the Beltrami coefficient of the rounding
    optimal_density_ratio : 95 % over 5 % quantile of the density that these poles allow without integers
    tiles : the number of tiles that was aimed at: area times median density
    quality : `Quality` on the triangles of the surface, diagonals flipped away from the poles
    seams : (#S, 2) vertices of the edges where the UVs jump
    """

    uv: Reals
    periods: Integers
    poles: Integers
    residues: Complexes
    zeros: tuple[Integers, Integers]
    added_distortion: float
    left_over: float
    optimal_density_ratio: float
    tiles: float
    quality: Quality
    seams: Integers

    def _facts(self):
        size = f"{self.tiles:.4g} tiles, {counted(len(self.poles), 'pole')}"
        return [size, f"density ratio {self.density_ratio:.4g}", f"mean s1/s2 {self.quality.mean_angle:.4g}"]

    @property
    def density_ratio(self) -> float:
        """95 % over 5 % quantile of s1 s2 by area."""
        return self.quality.density_ratio

    @property
    def verdict(self) -> Verdict:
        """The `Verdict` on the map."""
        return verdict(self.quality, len(self.poles), self.added_distortion)


@dataclass(frozen=True, repr=False)
class PlacedPoles(Value):
    """Vertices, complex residues up to a common factor, and the density ratio that they allow."""

    vertices: Integers
    residues: Complexes
    density_ratio: float

    def _facts(self):
        return [counted(len(self.vertices), "pole"), f"density ratio {self.density_ratio:.4g}"]


class Tiler:
    """The poles of a surface and what tilings with them are made of; changing tiles, lattice or direction is quick.

    Parameters
    ----------
    surface : Surface, connected
    poles : "auto" for as many as the density asks for, a number, or a list of vertices, which stay where they are
    boundary : "straight" for boundary loops along lines of constant v, "free" for a more even density; a surface with
        both handles and a boundary has straight ones in any case
    allowed : (#V,) bool, where poles may be that are not chosen; default anywhere
    solver, threads, progress : as in `conformal_structure`
    """

    def __init__(
        self,
        surface: Surface,
        poles: Poles = "auto",
        *,
        boundary: str = "straight",
        allowed: ArrayLike | None = None,
        solver: str = "auto",
        threads: int | None = 0,
        progress: Progress | None = None,
    ) -> None:
        if boundary not in BOUNDARIES:
            raise ValueError(f"boundary is {boundary!r}; one of {', '.join(BOUNDARIES)} is needed")
        surface.require_connected()
        self._surface, self._component, self._basis = surface, surface.components[0], None
        count, chosen = wished_poles(poles)
        vertices, labels = _own_poles(surface, self._component, chosen)
        self._native = _native.Tiler(self._component._native, boundary == "straight", labels, solver, threads or 0)
        self._native.place(count, vertices, _allowed(allowed, surface, self._component), progress)

    def __repr__(self) -> str:
        return f"<Tiler: {counted(len(self.poles.vertices), 'pole')} on {self._surface!r}>"

    def __reduce__(self):
        raise TypeError("a Tiler is neither copied nor pickled: take its tiling, or its surface and poles")

    @property
    def poles(self) -> PlacedPoles:
        """`PlacedPoles`."""
        vertices, residues, ratio = self._native.poles()
        return PlacedPoles(self._of_surface(vertices), residues, ratio)

    def tile(
        self,
        tiles: float | None = None,
        *,
        lattice: str | ArrayLike = "square",
        direction: ArrayLike | str | None = None,
        turn: float | None = None,
        max_turn: float = 0.2,
        max_added: float | None = None,
        progress: Progress | None = None,
    ) -> Tiling:
        """A `Tiling`; see `Structure.tile`. turn : radians by which the texture is rotated, beside the direction."""
        if max_added is not None and real_number(max_added, "max_added") < 1:
            raise ValueError(f"max_added is {max_added!r}; a mean s1 / s2 of at least 1 is needed")
        tiles = 0.0 if tiles is None else real_number(tiles, "tiles", positive=True)
        turn = None if turn is None else real_number(turn, "turn")
        max_turn = real_number(max_turn, "max_turn")
        a, b = _lattice(lattice)
        vector, turn = along(direction, turn, self._component)
        self._basis = np.array([[a.real, b.real], [a.imag, b.imag]])
        made = self._tiling(self._native.tile(tiles, a, b, turn, vector, max_turn, progress))
        if max_added is not None and made.added_distortion > max_added:
            raise TopologyError(_too_sheared(made, max_added, self._surface.genus))
        return made

    def with_poles_moved(self, moves: Mapping[int, int], *, progress: Progress | None = None) -> Tiling:
        """The `Tiling` that `tile` gave last with some of its poles elsewhere; changes nothing of the tiler.

        The residues stay, and so do the periods but where a pole has a shorter way to its place around a handle.
        Nothing is rounded again. On a surface with handles the other poles make up for what is left over, as far as
        they can: where they were chosen, `added_distortion` grows.

        moves : {index in `Tiling.poles`: vertex}
        """
        if self._basis is None:
            raise ValueError("with_poles_moved moves the poles of a tiling; call tile first")
        own, _ = _own_poles(self._surface, self._component, list(moves.values()))
        return self._tiling(self._native.with_poles_moved(list(zip(moves, own)), progress))

    def _tiling(self, made):
        uv, triangulation = made.uv(), made.surface()
        zeros, orders = made.zeros()
        jumps = made.periods().ravel()
        periods = np.linalg.solve(self._basis, np.stack([jumps.real, jumps.imag]))
        return Tiling(
            uv=uv,
            periods=arrays.frozen(np.rint(periods.T).astype(np.int64).reshape(-1, 2)),
            poles=self._of_surface(made.poles()),
            residues=made.residues(),
            zeros=(self._of_surface(zeros), orders),
            added_distortion=made.distortion,
            left_over=made.left_over,
            optimal_density_ratio=self.poles.density_ratio,
            tiles=made.tiles,
            quality=Quality.of(triangulation, uv, 0),
            seams=self._of_surface(triangulation.edges[made.seams()]),
        )

    def _of_surface(self, vertices):
        same = self._component is self._surface
        return vertices if same else arrays.frozen(self._component.vertex_index[vertices])


def place_poles(
    surface: Surface,
    count: Poles = "auto",
    *,
    boundary: str = "straight",
    allowed: ArrayLike | None = None,
    threads: int | None = 0,
    progress: Progress | None = None,
) -> PlacedPoles:
    """`PlacedPoles` of a connected surface: where poles make the texture density most even. Arguments as in `Tiler`.

    A greedy start, then moves of one pole at a time, poles taken away and added anew where they do best, and a few more
    than asked for of which those stay that matter, on a level of the progressive mesh of about 10,000 triangles.
    Deterministic."""
    return Tiler(surface, count, boundary=boundary, allowed=allowed, threads=threads, progress=progress).poles


def wished_poles(poles):
    """(count or None, chosen vertices). @throws ValueError or InvalidMesh for anything else"""
    if isinstance(poles, str):
        if poles != "auto":
            raise ValueError(f'poles is {poles!r}; "auto", a number or a list of vertices is needed')
        return None, []
    if isinstance(poles, numbers.Real):
        if not 0 <= poles <= 1000 or poles != int(poles):
            raise ValueError(f"poles is {poles!r}; a whole number from 0 to 1000 is needed")
        return int(poles), []
    vertices = arrays.integer(poles, "poles")
    return len(vertices), vertices


def _own_poles(surface, component, vertices):
    """As `own_vertices`; each only once."""
    own = own_vertices(surface, component, vertices, "pole")
    given, times = np.unique(np.asarray(vertices, int), return_counts=True)
    for vertex in given[times > 1]:
        raise TopologyError(f"pole {vertex} is given twice")
    return own


def _allowed(allowed, surface, component):
    if allowed is None:
        return []
    allowed = np.asarray(allowed, bool)
    count = surface._native.vertex_count
    if allowed.shape != (count,):
        raise ValueError(f"allowed has the shape {allowed.shape}; ({count},) is needed")
    own = allowed if component is surface else allowed[component.vertex_index]
    if not own.any():
        raise ValueError("allowed leaves no vertex for a pole")
    return own.tolist()


def _too_sheared(made, max_added, genus):
    """What can be had instead."""
    poles = counted(len(made.poles), "pole")
    advice = "take more tiles" if len(made.poles) >= genus else f"take {genus} poles or more, or more tiles"
    return (
        f"with {poles} and {made.tiles:.4g} tiles the added distortion is {made.added_distortion:.5g}, more than "
        f"max_added, {max_added:.5g}: {advice}"
    )


def _lattice(lattice):
    """Its two generators as complex numbers. @throws ValueError"""
    if isinstance(lattice, str):
        if lattice not in LATTICES:
            raise ValueError(f"lattice is {lattice!r}; one of {', '.join(LATTICES)} or a 2 x 2 matrix is needed")
        return tuple(complex(z) for z in LATTICES[lattice])
    matrix = arrays.numbers(lattice, "lattice")
    if matrix.shape != (2, 2) or not np.isfinite(matrix).all():
        raise ValueError(f"lattice has the shape {matrix.shape}; a finite 2 x 2 matrix is needed")
    if abs(np.linalg.det(matrix)) <= 1e-9 * np.abs(matrix).max() ** 2:
        raise ValueError("lattice is singular: its columns, the translations of the texture, must be independent")
    return complex(*matrix[:, 0]), complex(*matrix[:, 1])
