"""Checks the options of a tiling: poles, where they may be, the lattice of the texture."""

import math
import numbers
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Integers
from ..core.value import quoted
from ..mesh.checks import own_vertices
from ..mesh.edges import has_angle_on_one_boundary

LATTICES = {"square": (1, 1j), "brick": (1, 0.5 + 1j), "hex": (1, 0.5 + 0.5j * math.sqrt(3))}
BOUNDARIES = ("automatic", "straight", "free")
MOST_POLES, MOST_PER_TILE = 1000, 1000
Poles: TypeAlias = str | int | Sequence[int] | Integers  # "auto", a number, or vertices


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
    """Like `own_vertices`; refuses a pole that is given twice."""
    own = own_vertices(surface, component, vertices, "pole")
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


def is_straight(boundary, component, evened):
    """Whether the boundary of a tiling is to be straight. @throws ValueError"""
    if boundary not in BOUNDARIES:
        raise ValueError(f"boundary is {quoted(boundary)}; one of {', '.join(BOUNDARIES)} is needed")
    if boundary == "automatic":
        return not (evened and has_angle_on_one_boundary(component))
    return boundary == "straight"


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
