"""What a verdict reads, by hand; and quantiles of what was measured."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Measured:
    """What a verdict reads of a `Quality`; by default of a map without any distortion."""

    size_range: float = 1.0
    mean_angle: float = 1.0
    lost_part: float = 0.0
    flipped_part: float = 0.0
    overlapping_part: float | None = None
    unseen_angle: float = 0.0
    direction: None = None
    flipped: tuple = (False,)
    collapsed: tuple = (False,)
    area: np.ndarray = field(default_factory=lambda: np.ones(1))

    @property
    def density_ratio(self):
        return self.size_range**2


def quantiles(values, weights, shares):
    """The values below which these shares of the weights lie."""
    order = np.argsort(values, kind="stable")
    total = np.cumsum(weights[order])
    return [values[order[np.searchsorted(total, share * total[-1])]] for share in shares]
