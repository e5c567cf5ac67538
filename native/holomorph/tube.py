"""Tilings of tubes, whose whole tiles lie around them: along its axis a tube may be stretched to any density."""

from dataclasses import replace

import numpy as np

from . import arrays
from .map import Map
from .quality import Quality
from .surface import Surface


def is_tube(surface: Surface) -> bool:
    """Whether it is a sphere with two holes."""
    return (surface.genus, surface.boundary_count) == (0, 2)


def stretched(made: Map, density: float) -> Map | None:
    """The tiling with v multiplied until the median density is this one; None where v jumps, as where a texture goes
    round the tube in a helix."""
    uv, vertices = made.uv, made.surface.corner_vertices
    level = np.empty(len(made.surface.vertices))
    level[vertices] = uv[:, 1]
    if not np.array_equal(level[vertices], uv[:, 1]):
        return None
    uv = arrays.frozen(uv * [1.0, density / made.density])
    quality = replace(Quality.of(made.surface._native, uv, 0), unseen_angle=made.quality.unseen_angle)
    return replace(made, uv=uv, quality=quality, tiling=replace(made.tiling, uv=uv, quality=quality))
