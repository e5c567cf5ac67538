"""What a verdict reads, by hand."""

from dataclasses import dataclass


@dataclass
class Measured:
    """What a verdict reads of a `Quality`; by default of a map without any distortion."""

    density_ratio: float = 1.0
    capped_mean_angle: float = 1.0
    lost_part: float = 0.0
    long_part: float = 0.0
    mean_angle: float = 1.0
    overlapping_part: float | None = None
    unseen_angle: float = 0.0
    flipped: tuple = (False,)
    collapsed: tuple = (False,)
