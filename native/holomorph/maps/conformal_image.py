"""The image of a surface on the unit sphere or in the unit disk."""

from __future__ import annotations

import numpy as np

from ..core.array_types import Reals
from ..forms.log_map import PoleStructure
from ..forms.results import Structure
from ..mesh.checks import check_type
from ..plane.disk import DiskMap
from .automatic_structure import AnyStructure, LateStructure


def conformal_image(structure: AnyStructure) -> Reals | None:
    """(#V, 3) where the structure's map takes the vertices: of a sphere with two poles to the unit sphere, of a
    `DiskMap` to the unit disk in the plane z = 0. NaN at isolated vertices; None for other structures.

    Raises SolverError, as a map may be solved for when it is first used.
    Source: Gu, Wang, Yau (2003), § 11: the exponential of the integral of a differential with two poles.

    Examples
    --------
    >>> x, y = np.mgrid[0:9, 0:9]
    >>> corner = (9 * x + y)[:-1, :-1].ravel()
    >>> faces = np.stack([corner, corner + 9, corner + 10, corner + 1], axis=1)
    >>> sheet = holomorph.Surface(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), faces)
    >>> image = holomorph.conformal_image(holomorph.disk_map(sheet, centre=40))
    >>> print(image.shape, image[40].round(3))
    (81, 3) [0. 0. 0.]
    """
    if isinstance(structure, LateStructure):  # beside islands, which have no image
        return None
    check_type(structure, Structure, "structure")
    if isinstance(structure, DiskMap):
        disk = structure.disk_map()
        return np.stack([disk.real, disk.imag, 0 * disk.real], axis=1)
    component = structure._component
    is_sphere = (component.genus, component.boundary_count) == (0, 0)
    if is_sphere and isinstance(structure, PoleStructure) and len(structure.poles) == 2:
        return structure.sphere_map()
    return None
