# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours of a heat map. Arrays only, no bpy."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Scale:
    """The colours of a quantity along a bar, and what is written beside them."""

    stops: tuple  # sRGB, evenly along the bar
    ticks: tuple  # (place, text)

    def colours(self, places):
        """(n, 3) float32 sRGB at places on the bar; places beyond its ends are moved there."""
        at = np.linspace(0, 1, len(self.stops))
        return np.stack([np.interp(places, at, channel) for channel in np.transpose(self.stops)], -1).astype(np.float32)


OCTAVES_SHOWN = 4.0  # on either side of the median

DENSITY = Scale(
    ((0.13, 0.27, 0.60), (0.40, 0.62, 0.80), (0.90, 0.89, 0.86), (0.93, 0.60, 0.36), (0.66, 0.13, 0.14)),
    ((0.0, "1/16"), (0.25, "1/4"), (0.5, "median"), (0.75, "4"), (1.0, "16")),
)
ANGLE = Scale(
    ((0.90, 0.89, 0.86), (0.95, 0.80, 0.45), (0.91, 0.47, 0.28), (0.68, 0.16, 0.35), (0.28, 0.05, 0.33)),
    ((0.0, "1"), (0.316, "1.1"), (0.548, "1.3"), (0.775, "1.6"), (1.0, "2")),
)


def density_places(octaves):
    return 0.5 + octaves / (2 * OCTAVES_SHOWN)


def angle_places(angle):
    """Places on the bar of s1 / s2. The root shows small distortions well: most are small."""
    return np.sqrt(np.clip(angle - 1, 0, 1))
