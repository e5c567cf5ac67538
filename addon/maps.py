# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps out of a solve: coefficients, dials, scale and rotation. Arrays only, no bpy."""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from .mesh_io import MAIN_MAP

SAMPLED = 50_000  # triangles, for a median
SQUARES_ACROSS = 32  # along the diagonal of the bounding box, where the density is the median one
SQUARES_LIMIT = 10_000
CENTRE = 0.5 + 0.5j  # every component is centred in the unit square; artists pack from there


@dataclass(frozen=True)
class MapOptions:
    """What the redo panel's sliders change; none of it needs a new solve."""

    forms: int = 8  # basis forms that get a map of their own, at most
    density: float = 1.0  # factor of UV lengths; at 1 each component has UV area 1
    rotation: float = 0.0  # radians, counter-clockwise
    amounts: tuple = ()  # factor of each form's share in the main map; none means 1
    turns: tuple = ()  # radians, phase of each form's share in the main map


def map_names(solved, options):
    """The main map, then one for each form up to the largest genus among the components."""
    count = min(solved.form_count, options.forms)
    return [MAIN_MAP] + [f"{MAIN_MAP} {j + 1}" for j in range(count)]


def map_values(solved, options):
    """Yields (name, (#C,2) float32) for every map; components that lack the form are zero there."""
    for index, name in enumerate(map_names(solved, options)):
        uv = np.zeros((len(solved.surface.corner_vertices), 2), np.float32)
        for component in solved.components:
            if component.structure is not None and index <= component.form_count:
                uv[component.surface.corner_index] = component_uv(component, index, options)
        yield name, uv


def coefficients(component, index, options):
    """(g,) complex: the balanced combination with its dials for index 0, else the unit of form `index`."""
    if index > 0:
        return np.eye(component.form_count, dtype=complex)[index - 1]
    dials = np.array(options.amounts) * np.exp(1j * np.array(options.turns))
    result = np.array(component.balanced, complex)
    shared = min(len(result), len(dials))
    result[:shared] *= dials[:shared]
    return result


def uv_area(z, triangle_corners):
    """The signed integral of du dv over the triangles, z = u + i v at the corners."""
    p, q, r = z[triangle_corners].T
    return 0.5 * float(np.vdot(q - p, r - p).imag)


def component_uv(component, index, options):
    """(#C of the component, 2) float64 with UV area density^2, centred in the unit square.

    Centred before rounding to float32: the two copies of a seam edge stay equal to the last bits.
    """
    z = _as_complex(component.structure.uv(coefficients(component, index, options)))
    middle, area = _frame(component, index, options, z)
    # No area is left where all dials are at zero: a point, in the middle like everything else.
    scale = options.density / math.sqrt(area) * cmath.exp(1j * options.rotation) if area > 0 else 0
    z = z - middle
    z *= scale
    z += CENTRE
    return z.view(np.float64).reshape(-1, 2)


def _frame(component, index, options, z):
    """The middle of the bounding box and the area, kept: they cost more than everything else here."""
    key = (index, options.amounts, options.turns) if index == 0 else index
    if key not in component.frames:
        u, v = z.real, z.imag
        middle = complex(u.min() + u.max(), v.min() + v.max()) / 2
        component.frames[key] = middle, abs(uv_area(z - middle, component.surface.triangle_corners))
    return component.frames[key]


def _as_complex(uv):
    return np.ascontiguousarray(uv).view(np.complex128)[:, 0]


@dataclass(frozen=True)
class MainQuality:
    """Distortion of the main map; scale and rotation do not matter."""

    mean_angle: float
    density_ratio: float
    flipped: int  # triangles
    length_ratio: float  # UV length per length on the surface, the median by area, at density 1


def main_quality(component, options):
    """The quality of the main map, kept for each setting of its dials."""
    dials = (options.amounts, options.turns)
    if dials not in component.qualities:
        uv = component.structure.uv(coefficients(component, 0, options))
        quality = component.structure.quality(uv)
        _, area = _frame(component, 0, options, _as_complex(uv))
        ratio = _median_by_area(component.surface, quality.area)
        component.qualities[dials] = MainQuality(
            float(quality.mean_angle),
            float(quality.density_ratio),
            int(np.count_nonzero(quality.flipped)),
            math.sqrt(ratio / area) if area > 0 else 0.0,
        )
    return component.qualities[dials]


def _median_by_area(surface, values):
    """The median of a value of each triangle, weighted by surface area, over a regular sample of the triangles."""
    step = -(-len(values) // SAMPLED)
    sample = values[::step]
    p, q, r = surface.vertices[surface.triangles[::step]].transpose(1, 0, 2)
    weights = np.linalg.norm(np.cross(q - p, r - p), axis=1)
    order = np.argsort(sample, kind="stable")
    below = np.cumsum(weights[order])
    return float(sample[order][np.searchsorted(below, below[-1] / 2)])


def squares_that_fit(solved, options):
    """Checker squares per UV unit so that about `SQUARES_ACROSS` of them span the largest part that has a map."""
    parts = [c for c in solved.components if c.structure is not None]
    sizes = [float(np.linalg.norm(np.ptp(c.surface.vertices, axis=0))) for c in parts]
    size, part = max(zip(sizes, parts), key=lambda pair: pair[0])
    density = options.density * main_quality(part, options).length_ratio * size
    return min(max(2 * round(SQUARES_ACROSS / density / 2), 2), SQUARES_LIMIT) if density > 0 else SQUARES_ACROSS
