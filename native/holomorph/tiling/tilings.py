"""Seamless tilings, UV maps of even density whose jumps are symmetries of the texture; and what is asked of them."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Reals
from ..core.value import Value, counted, quoted
from ..mesh.checks import own_vertices
from ..mesh.surface import Surface
from ..quality.appearance import CONE, POLE
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, special, verdict

LATTICES = {"square": (1, 1j), "brick": (1, 0.5 + 1j), "hex": (1, 0.5 + 0.5j * math.sqrt(3))}
BOUNDARIES = ("automatic", "straight", "free")
MOST_POLES, MOST_PER_TILE = 1000, 1000
Poles: TypeAlias = str | int | Sequence[int] | Integers  # "auto", a number, or vertices
UPRIGHT = "upright"
UP = {"Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}  # by `Surface.up`


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
        zeros, orders = made.zeros
        return cls(
            uv=made.uv,
            periods=made.periods,
            poles=vertices_of(surface, made.poles),
            residues=made.residues,
            zeros=(vertices_of(surface, zeros), orders),
            evenness=made.evenness,
            added_distortion=made.added_distortion,
            beltrami_rms=made.beltrami_rms,
            optimal_size_range=made.optimal_size_range,
            rounding=Rounding(*made.rounding),
            tiles=made.tiles,
            quality=Quality._of(made.quality, made.triangulation, surface.up),
            seams=vertices_of(surface, made.seams),
            lattice=arrays.frozen(np.array([[z.real, z.imag] for z in made.lattice]).T.copy()),
            turns=made.turns,
            cones=vertices_of(surface, made.cones),
            cone_angles=made.cone_angles,
            jumps=made.jumps,
            lines=made.lines,
        )

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


def asked_poles(poles):
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


def own_poles(surface, component, vertices):
    """The vertices of `own_vertices`; refuses a pole that is given twice."""
    if not len(vertices):
        return []
    own, _ = own_vertices(surface, component, vertices, "pole")
    given, times = np.unique(np.asarray(vertices, int), return_counts=True)
    for vertex in given[times > 1]:
        raise TopologyError(f"pole {vertex} is given twice")
    return own


def own_allowed(allowed, surface, component):
    """Where poles may be, by the component's vertices; [] for anywhere. @throws ValueError"""
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


def heading(direction):
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
