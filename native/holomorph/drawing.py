"""What both kinds of plots draw: checked, as arrays."""

import numpy as np
from numpy.typing import ArrayLike

from ._native import InvalidMesh
from .core import arrays
from .core.array_types import Reals
from .core.value import quoted
from .forms.form_structure import FormStructure
from .mesh.surface import Surface

SQUARES = ((0.96, 0.94, 0.91), (0.84, 0.43, 0.20))  # the two colours of a checker
PLAIN = (0.75, 0.75, 0.78)
ZERO = (0.85, 0.05, 0.10)
DECADES = 1.0  # powers of 10 of the density, to each side of the median
DENSITY = "density over its median, powers of 10"
SEEN_THROUGH = 0.35  # opacity of a surface that shows what is on its other side
MOST_FORMS = 8  # that are drawn side by side


def checked_uv(surface: Surface, uv: ArrayLike) -> Reals:
    """The UVs as reals. @throws ValueError if they are not those of the surface, @throws InvalidMesh"""
    require_positions(surface)
    uv = arrays.numbers(uv, "uv")
    if uv.shape != (len(surface.corner_vertices), 2) or not np.isfinite(uv).all():
        raise ValueError(f"uv has the shape {uv.shape}; ({len(surface.corner_vertices)}, 2) finite numbers are needed")
    return uv


def require_positions(surface: Surface) -> None:
    """@throws InvalidMesh"""
    if surface.vertices is None:
        raise InvalidMesh("an intrinsic surface, without positions, cannot be drawn")


def upright(points: Reals, up: str) -> Reals:
    """(..., 3) points with the axis `up`, "Y" or "Z", as third one."""
    if up not in ("Y", "Z"):
        raise ValueError(f'up is {quoted(up)}; "Y" or "Z" is needed')
    return points if up == "Z" else points[..., [0, 2, 1]] * np.array([1, -1, 1])


def density_decades(surface: Surface, uv: Reals) -> Reals:
    """(#T,) log10 of UV area over area of each triangle, over the median."""
    corners, values = surface.vertices[surface.triangles], uv[surface.triangle_corners]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    found = _doubled_areas(values) / np.where(area > 0, area, 1.0)
    tiny = np.finfo(float).tiny
    return np.log10(np.maximum(found, tiny)) - np.log10(max(np.median(found[area > 0]), tiny))


def form_maps(structure: FormStructure) -> list[Reals]:
    """(#C, 2) of each form alone, of `MOST_FORMS` at most, scaled to the UV area 1."""
    units = np.eye(structure.form_count)[:MOST_FORMS]
    maps = [structure.uv(unit) for unit in units]
    corners = structure.surface.triangle_corners
    return [uv / np.sqrt(_doubled_areas(uv[corners]).sum() / 2) for uv in maps]


def _doubled_areas(triangles):
    a, b = np.moveaxis(triangles[:, 1:] - triangles[:, :1], 1, 0)
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
