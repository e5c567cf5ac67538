"""One-forms as vector fields on the triangles of a surface."""

import numpy as np

from .._native import InvalidMesh
from ..core import arrays


def vectors(surface, form):
    """(#T, 3) the tangent vector X of each triangle with X . e = form(e) on its sides, for a closed form, (#E,) real or
    complex: of sides 0 and 2, which start and end at the first corner. NaN in triangles without area.

    Raises InvalidMesh for an intrinsic surface, which has no tangent vectors in space.
    """
    if surface.intrinsic:
        raise InvalidMesh("vectors need positions, and this surface has edge lengths only")
    first, second, third = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    ahead, back = second - first, third - first
    normal = np.cross(ahead, back)
    sides = surface.triangle_edges[:, [0, 2]]
    start, end = surface.triangles[:, [0, 0]], surface.triangles[:, [1, 2]]
    along = np.where(start < end, form[sides], -form[sides])
    with np.errstate(divide="ignore", invalid="ignore"):
        field = along[:, :1] * np.cross(back, normal) + along[:, 1:] * np.cross(normal, ahead)
        field /= (normal**2).sum(axis=1)[:, None]
    field[~np.isfinite(field)] = np.nan
    return arrays.frozen(field)
