"""A tiling of another density than whole tiles allow: stretched across the line along which all its jumps run."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..quality.quality import Quality
from ..tiling.tiling_options import generators
from ..tiling.tilings import Tiling
from .arrangement import on_grid

MOST_STRETCHED = 1.35  # factor: whole tiles around a limb, from three on, are never further from the wanted size
ALONG = 1e-9  # sine of an angle that is rounding


def stretched(tiling: Tiling, factor: float, lattice: str | ArrayLike) -> Tiling | None:
    """The tiling with this multiple of its density, stretched across its jumps where these all run along one line, as
    around a limb with a pole at each end: no seam shows all the same. None where there are jumps both ways, or it would
    be stretched by more than `MOST_STRETCHED`.

    factor : more than 0; lattice : of the tiling, as in `Structure.tile`
    """
    jumps = np.concatenate([tiling.residues, tiling.periods @ np.array(generators(lattice))])
    if not len(jumps) or not 1 / MOST_STRETCHED <= factor <= MOST_STRETCHED:
        return None
    line = jumps[np.abs(jumps).argmax()]
    if not np.all(np.abs((np.conj(line) * jumps).imag) <= ALONG * abs(line) ** 2):
        return None
    # Both sides of a cut are as far across the line, exactly, and are shifted by the same.
    across = np.array([-line.imag, line.real])
    shift = ((factor - 1) / abs(line) ** 2) * (tiling.uv @ across)[:, None] * across
    uv = arrays.frozen(tiling.uv + on_grid(shift))
    return replace(tiling, uv=uv, tiles=factor * tiling.tiles, quality=_scaled(tiling.quality, uv, factor))


def _scaled(before, uv, factor):
    """The `Quality` where all areas are multiplied. Their quantiles are, too: measured again, rounding might take
    another of two triangles between which the median is."""
    area, median = arrays.frozen(factor * before.area), factor * before.median_density
    same = {"density_ratio": before.density_ratio, "unseen_angle": before.unseen_angle}
    return replace(Quality.of(before._triangulation, uv, 1), area=area, median_density=median, **same)
