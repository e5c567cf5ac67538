# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps out of a solve: coefficients, dials, scale and rotation. Arrays only, no bpy."""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from .mesh_io import MAIN_MAP

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
    key = (index, options.amounts, options.turns) if index == 0 else index
    if key not in component.frames:
        component.frames[key] = _frame(z, component.surface.triangle_corners)
    middle, area = component.frames[key]
    # No area is left where all dials are at zero: a point, in the middle like everything else.
    scale = options.density / math.sqrt(area) * cmath.exp(1j * options.rotation) if area > 0 else 0
    z = z - middle
    z *= scale
    z += CENTRE
    return z.view(np.float64).reshape(-1, 2)


def _frame(z, triangle_corners):
    """The middle of the bounding box, and the area."""
    u, v = z.real, z.imag
    middle = complex(u.min() + u.max(), v.min() + v.max()) / 2
    return middle, abs(uv_area(z - middle, triangle_corners))


def _as_complex(uv):
    return np.ascontiguousarray(uv).view(np.complex128)[:, 0]


def main_quality(component, options):
    """(mean angle, density ratio, flipped triangles) of the main map; scale and rotation do not matter."""
    dials = (options.amounts, options.turns)
    if dials not in component.qualities:
        quality = component.structure.quality(component.structure.uv(coefficients(component, 0, options)))
        flipped = int(np.count_nonzero(quality.flipped))
        component.qualities[dials] = (float(quality.mean_angle), float(quality.density_ratio), flipped)
    return component.qualities[dials]
