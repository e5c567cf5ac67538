"""Evening of the maps of structures, and what each kind keeps."""

import numpy as np

from ..forms.bounded import BoundedStructure
from ..forms.pole_structure import PoleStructure
from ..plane.plane_maps import DiskMap, RectangleMap, TriangleMap
from ..tiling.evening import evened

MOST_SPREAD = 0.6  # mean distance of the density's logarithm from its median, from which on evening is lessened


def evened_uv(structure, coefficients, uv, quality, evenness, progress):
    """(#C, 2) UVs of a structure's map, evened; see `evened`. Shear grows with evenness and with how far densities
    differ: where squares of most sizes occur, evenness is lessened until no more shear than elsewhere comes of it.

    quality : `Quality` of the UVs"""
    evenness *= min(1.0, MOST_SPREAD / max(quality.density_spread, MOST_SPREAD))
    options = {"threads": structure._threads or None, "progress": progress}
    return evened(structure._triangulation, uv, evenness, **_kept(structure, coefficients), **options)


def _kept(structure, coefficients):
    """The vertices that `evened` keeps, under its names: those of straight and round boundaries, the centre of a round
    one, and poles."""
    surface = structure._triangulation
    rim = np.unique(surface.edges[np.bincount(surface.triangle_edges.ravel(), minlength=len(surface.edges)) == 1])
    if isinstance(structure, RectangleMap):
        points = structure._plane[rim]
        return {"u": rim[_is_extreme(points.real)], "v": rim[_is_extreme(points.imag)]}
    if isinstance(structure, DiskMap):
        still = [*rim, *structure._native.poles()]
        return {"u": still, "v": still}
    if isinstance(structure, TriangleMap):
        return {"u": rim, "v": rim}
    if isinstance(structure, PoleStructure):
        is_straight = np.isreal(coefficients).all() and np.isreal(structure.residues).all()
        return {"poles": structure._native.poles(), "v": rim if is_straight else ()}
    return {"v": rim} if isinstance(structure, BoundedStructure) else {}


def _is_extreme(values):
    return (values == values.min()) | (values == values.max())
