"""Cone points: a disk cut open where its flat map would be stretched most, so that its density becomes even."""

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core.array_types import Progress
from ..mesh.checks import check_type, real_number
from ..mesh.cut_open import cut_open
from ..mesh.surface import Surface
from ..plane.disk import free_boundary_map

MOST_CUTS = 32


def cut_to_cones(disk: Surface, most_stretch: float = 3.0, *, progress: Progress | None = None) -> Surface:
    """The disk cut open along its edges until its map with a free boundary keeps lengths up to a factor.

    Where the scale factor of that map is farthest from 1, there is a cone point: a vertex at the end of a cut, at which
    the flat map may have any angle. The cut goes the shortest way to the boundary. The finger of a glove, its tip a
    hundredth of its size, becomes a sleeve with a seam.

    Parameters
    ----------
    disk : Surface with positions, of genus 0 with one boundary loop
    most_stretch : above 1; a vertex whose scale factor is beyond it, or below its inverse, gets a cut, the worst first,
        up to 32 of them. Where the mesh is coarse some may stay beyond

    Raises TopologyError for a surface that is not a disk, ValueError for a factor that is not above 1; SolverError;
    Cancelled.

    Cost: one map with a free boundary for each cut, and one more.
    Source: cone points, Kharevych, Springborn and Schroeder 2006, doi:10.1145/1138450.1138461; the map, Sawhney and
    Crane 2017, doi:10.1145/3132705.

    Examples
    --------
    >>> roof = [(0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
    >>> disk = holomorph.Surface(roof, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)])
    >>> print(disk.vertices.shape, holomorph.cut_to_cones(disk, 1.05).vertices.shape)
    (5, 3) (6, 3)
    """
    check_type(disk, Surface)
    if (disk.genus, disk.boundary_count) != (0, 1) or disk.vertices is None:
        raise TopologyError("cone points need a disk with positions: genus 0 and 1 boundary")
    most = real_number(most_stretch, "most_stretch", positive=True)
    if most <= 1:
        raise ValueError(f"most_stretch is {most}; a factor above 1 is needed")
    for _ in range(MOST_CUTS):
        found = free_boundary_map(disk, progress=progress)
        stretch = np.nan_to_num(np.abs(np.log(found.scale_factors)))  # isolated vertices have none
        worst = int(np.argmax(stretch))
        if not stretch[worst] > np.log(most):
            break
        disk = _cut_from(disk, worst)
    return disk


def _cut_from(disk, vertex):
    no_seam = np.zeros(len(disk._native.edges), bool)
    is_start = np.zeros(len(disk.vertices), bool)
    is_start[vertex] = True
    border = _native.on_border(disk._native, no_seam)
    return cut_open(disk, _native.paths_to_border(disk._native, border, is_start))
