"""The image of a surface on the unit sphere or in the unit disk."""

from __future__ import annotations

import numpy as np

from ..core.array_types import Reals
from ..forms.pole_structure import PoleStructure
from ..forms.results import Structure
from ..mesh.checks import check_type
from ..plane.plane_maps import DiskMap
from .automatic_structure import AnyStructure


def conformal_image(structure: AnyStructure) -> Reals | None:
    """(#V, 3) where the structure's map takes the vertices: of a sphere with two poles to the unit sphere, of a
    `DiskMap` to the unit disk in the plane z = 0. NaN at isolated vertices; None for other structures."""
    check_type(structure, Structure, "structure")
    if isinstance(structure, DiskMap):
        disk = structure.disk_map()
        return np.stack([disk.real, disk.imag, 0 * disk.real], axis=1)
    component = structure._component
    is_sphere = (component.genus, component.boundary_count) == (0, 0)
    if is_sphere and isinstance(structure, PoleStructure) and len(structure.poles) == 2:
        return structure.sphere_map()
    return None
