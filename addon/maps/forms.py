# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of the forms of a solve beside their maps: coefficients by the dials, images in space. No bpy here."""

from dataclasses import replace

import numpy as np

from ..native import holomorph

SQUARES_LIMIT = 10_000


def coefficients(component, options):
    """The balanced combination of the forms of a part with its dials.

    Real where the balanced one is: a complex factor would bend the straight boundaries.
    """
    balanced = np.asarray(component.structure.balanced_coefficients())
    dials = np.array(options.amounts, float)
    if np.iscomplexobj(balanced):
        dials = dials * np.exp(1j * np.array(options.turns))
    result = balanced.copy()
    shared = min(len(result), len(dials))
    result[:shared] *= dials[:shared]
    return result


def shape_points(solved):
    """(#V,3) conformal images of the parts that have one, zeros elsewhere; None if no part has one."""
    found = [(holomorph.conformal_image(part.structure), part.surface.vertex_index) for part in solved.done]
    points = np.zeros((len(solved.polygons.vertices), 3))
    for image, own in found:
        if image is not None:
            points[own] = image[own]
    return points if any(image is not None for image, _ in found) else None


def squares_that_fit(maps, arrangement, across):
    """Squares of a texture per UV unit so that about `across` of them lie along the diagonal of the bounding box of the
    largest part where the density is the median one, at density 1; an even number."""
    size = max(holomorph.arrangement.diagonal(made.surface) for made in maps)
    unit = holomorph.arrangement.unit_length(maps, replace(arrangement, density=1.0))
    return min(max(2 * round(across * unit / size / 2), 2), SQUARES_LIMIT) if unit > 0 else across
