"""The distortion of UV maps."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Quality:
    """Distortion of a UV map per triangle, s1 >= s2 its singular values.

    angle: (#T,) s1 / s2 (1 where a triangle has no area, infinite where it has collapsed or a UV is not finite); area:
    (#T,) s1 s2, UV area per surface area; flipped: (#T,) bool; mean_angle: mean of s1 / s2 over the area of the
    triangles that have not collapsed; density_ratio: 95 % over 5 % quantile of s1 s2 by area; median_density: its 50 %
    quantile.
    """

    angle: np.ndarray
    area: np.ndarray
    flipped: np.ndarray
    mean_angle: float
    density_ratio: float
    median_density: float

    @property
    def collapsed(self):
        """(#T,) bool: the map leaves a triangle with area next to none."""
        return np.isinf(self.angle)
