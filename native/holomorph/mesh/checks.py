"""Checks of what results are made from."""

from __future__ import annotations

import math
import numbers
import os

import numpy as np
from numpy.typing import ArrayLike

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Reals
from ..core.value import quoted
from .surface import Surface

SOLVERS = ("auto", "direct", "multigrid", "paper")


def check_options(solver, threads):
    """The number of threads to use. @throws ValueError"""
    check_name(solver, SOLVERS, "solver")
    return check_threads(threads)


def check_name(value, names, noun):
    """@throws ValueError where `value` is none of these names"""
    if not isinstance(value, str) or value not in names:
        raise ValueError(f"{noun} is {quoted(value)}; one of {', '.join(names)} is needed")


def check_threads(threads):
    """The number of threads to use. @throws ValueError"""
    if threads is None:
        return os.cpu_count() or 1
    if not isinstance(threads, numbers.Real) or not 1 <= threads < 2**31 or threads != int(threads):
        raise ValueError(f"threads is {quoted(threads)}; a positive integer below 2**31, or None, is needed")
    return int(threads)


def check_memory_limit(memory_limit):
    """The limit in bytes, 0 for none. @throws ValueError"""
    if memory_limit is None:
        return 0
    is_number = isinstance(memory_limit, numbers.Real) and not isinstance(memory_limit, bool)
    if not is_number or not 1 <= memory_limit < 2**63:
        raise ValueError(f"memory_limit is {quoted(memory_limit)}; a positive number of bytes or None is needed")
    return int(memory_limit)


def check_thresholds(thresholds, solver):
    """Numbers of faces as integers, None for those that the paper's solver takes. @throws ValueError"""
    if thresholds is None:
        return None
    if solver != "paper":
        raise ValueError(f"thresholds need solver='paper', but solver is {quoted(solver)}")
    return [int(min(real_number(faces, "a threshold", positive=True), 2**62)) for faces in thresholds]


def check_bounds(width, most_faces):
    """(relative width, number of triangles), None where no width is asked for. @throws ValueError"""
    if width is None:
        return None
    if real_number(width, "bounds", positive=True) >= 1:
        raise ValueError(f"bounds is {quoted(width)}; a relative width below 1 is needed")
    return float(width), int(real_number(most_faces, "most_faces", positive=True))


def as_float(value):
    """A real number, rounded; infinite where it is beyond all floats, NaN where it is none."""
    try:
        return float(value) if isinstance(value, numbers.Real) else math.nan
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def real_number(value: object, name: str, positive: bool = False) -> float:
    """`value` as a finite float. @throws ValueError"""
    found = as_float(value)
    if not math.isfinite(found) or (positive and found <= 0):
        raise ValueError(f"{name} is {quoted(value)}; a {'positive' if positive else 'finite'} number is needed")
    return found


def whole_number(value: object, name: str, least: int = 0) -> int:
    """`value` as an integer that indices reach. @throws ValueError"""
    found = as_float(value)
    if not least <= found < 2**31 or found != int(found):
        raise ValueError(f"{name} is {quoted(value)}; a whole number from {least} to below 2**31 is needed")
    return int(found)


def check_list(value, name):
    """@throws ValueError where `value` has no entries to go through"""
    if isinstance(value, (str, bytes)) or not np.iterable(value):
        raise ValueError(f"{name} is {quoted(value)}; a list is needed")


def checked_evenness(value):
    """An evenness as a float. @throws ValueError"""
    if not 0 <= as_float(value) <= 1:
        raise ValueError(f"evenness is {quoted(value)}; a number from 0 (keeps angles) to 1 (equal sizes) is needed")
    return float(value)


def check_type(value, kind, name="surface"):
    """@throws TypeError where `value` is none of this kind"""
    if not isinstance(value, kind):
        raise TypeError(f"{name} is of type {type(value).__name__}; a {kind.__name__} is needed")


def only_component(surface):
    """The one component of a connected surface, without isolated vertices. @throws TypeError or TopologyError"""
    check_type(surface, Surface)
    surface.require_connected()
    return surface.components[0]


def own_vertices(surface, component, vertices, noun):
    """`vertices` of the surface as a list of the component's, and labels: the surface's index of each of the
    component's vertices, [] if both are the same. `noun` says in messages what they are.

    Raises TopologyError for anything but indices of vertices that have a face.
    """
    given = np.asarray(vertices)
    if given.ndim != 1 or not (np.issubdtype(given.dtype, np.integer) or given.size == 0):
        raise TopologyError(f"{noun}s must be a list of vertex indices, not an array of {given.dtype} of {given.shape}")
    count = surface._native.vertex_count
    for vertex in given[(given < 0) | (given >= count)]:
        raise TopologyError(f"{noun} {vertex} is not a vertex: there are {count}")
    if component is surface:
        return given.tolist(), []
    own = np.full(count, -1)
    own[component.vertex_index] = np.arange(len(component.vertex_index))
    for vertex in given[own[given.astype(int)] < 0]:
        raise TopologyError(f"{noun} {vertex} belongs to no face")
    return own[given.astype(int)].tolist(), component.vertex_index.tolist()


def checked_uv(uv: ArrayLike, surface: Surface, is_finite: bool = False) -> Reals:
    """`uv` as reals, (#C, 2) at the polygon corners of the surface. @throws ValueError"""
    uv, count = arrays.numbers(uv, "uv"), len(surface.corner_vertices)
    if uv.shape != (count, 2) or (is_finite and not np.isfinite(uv).all()):
        wanted = f"({count}, 2) {'finite numbers are' if is_finite else 'is'} needed"
        raise ValueError(f"uv has the shape {uv.shape}; {wanted}")
    return uv


def checked_coefficients(coefficients, count, kind):
    """`coefficients` as (count,) finite numbers of type `kind`. @throws ValueError"""
    c = np.asarray(coefficients)
    if np.ma.is_masked(coefficients) or c.dtype.kind not in "biufc":
        raise ValueError(f"coefficients must be numbers, none of them masked, not {quoted(coefficients)}")
    if c.shape != (count,) or not np.isfinite(c).all() or (kind is not np.complex128 and np.iscomplexobj(c)):
        wanted = f"({count},) finite {'numbers are' if kind is np.complex128 else 'real numbers are'} needed"
        raise ValueError(f"coefficients has the shape {c.shape}; {wanted}")
    return c.astype(kind)
