"""Seamless tilings, UV maps of even density whose jumps are symmetries of the texture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import TypeAlias

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Complexes, Integers, Reals
from ..core.value import Value, counted, quoted
from ..mesh.surface import Surface
from ..quality.appearance import CONE, POLE
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, special, verdict

LATTICES = {"square": (1, 1j), "brick": (1, 0.5 + 1j), "hex": (1, 0.5 + 0.5j * math.sqrt(3))}
BOUNDARIES = ("automatic", "straight", "free")
MOST_POLES, MOST_PER_TILE = 1000, 1000
Poles: TypeAlias = str | int | Sequence[int] | Integers  # "auto", a number, or vertices
UPRIGHT = "upright"


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
        component, (zeros, orders) = surface.components[0], made.zeros
        own = {"zeros": zeros, "poles": made.poles, "seams": made.seams, "cones": made.cones}
        if component is not surface:
            own = {name: arrays.frozen(component.vertex_index[vertices]) for name, vertices in own.items()}
        values = {one.name: getattr(made, one.name) for one in fields(cls)} | own | {"zeros": (own["zeros"], orders)}
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
