# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps out of a solve: coefficients, dials, scale and rotation. Arrays only, no bpy."""

import cmath
from dataclasses import dataclass

import numpy as np

from .mesh_io import MAIN_MAP

CENTRE = (0.5, 0.5)  # every component is centred in the unit square; artists pack from there


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


def uv_area(uv, triangle_corners):
    """The signed integral of du dv over the triangles."""
    p, q, r = (uv[triangle_corners[:, k]] for k in range(3))
    a, b = q - p, r - p
    return 0.5 * float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))


def component_uv(component, index, options):
    """(#C of the component, 2) float64 with UV area density^2, centred in the unit square.

    Centred before rounding to float32: the two copies of a seam edge stay equal to the last bits.
    """
    uv = component.structure.uv(coefficients(component, index, options))
    uv = uv - (uv.min(axis=0) + uv.max(axis=0)) / 2
    area = abs(uv_area(uv, component.surface.triangle_corners))
    if area == 0.0:  # all dials at zero
        return np.full_like(uv, CENTRE)
    scale = options.density / np.sqrt(area) * cmath.exp(1j * options.rotation)
    turned = np.array([[scale.real, scale.imag], [-scale.imag, scale.real]])
    return uv @ turned + CENTRE


def main_quality(component, options):
    """(mean angle, density ratio, flipped triangles) of the main map; scale and rotation do not matter."""
    dials = (options.amounts, options.turns)
    if dials not in component.qualities:
        quality = component.structure.quality(component_uv(component, 0, options))
        flipped = int(np.count_nonzero(quality.flipped))
        component.qualities[dials] = (float(quality.mean_angle), float(quality.density_ratio), flipped)
    return component.qualities[dials]
