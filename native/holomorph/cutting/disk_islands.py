"""The islands into which seams cut a surface, each cut open until it can be flattened."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .._native import InvalidMesh, SolverError, TopologyError
from ..core.array_types import Progress
from ..core.progress import scaled
from ..forms.structure import conformal_structure
from ..mesh.surface import Surface
from .cones import cut_to_cones
from .islands import islands


def disk_islands(
    surface: Surface,
    seams: ArrayLike = (),
    strict: bool = True,
    *,
    hard_edges: float | None = None,
    most_stretch: float | None = None,
    progress: Progress | None = None,
) -> tuple[Surface, ...]:
    """The `islands`, those with several boundary loops, or with a boundary and handles, cut open to disks along the
    seams of their structure. Closed islands stay, and so do those for which this cannot be done.

    most_stretch : factor by which lengths may change in the flat map of a disk; where it is more, the disk is cut open
        by `cut_to_cones`. None: no such cuts
    seams, strict, hard_edges : as in `islands`; progress : as in `conformal_structure`

    Raises what `islands` raises; ValueError for a factor that is not above 1; Cancelled.
    Source: Gu, Wang, Yau (2003), § 4, for the seams; Sawhney & Crane (2017) for cone points.

    Examples
    --------
    >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = holomorph.Surface(corners, sides)
    >>> print(len(holomorph.disk_islands(cube, hard_edges=60)))
    6
    """
    asked = scaled(progress, 0.0, 0.0)  # whether to go on; how long it takes is not known
    disks = []
    for part in islands(surface, seams, strict, hard_edges=hard_edges):
        disks += _opened(part, asked)
    return tuple(disks if most_stretch is None else [_cut_to_cones(part, most_stretch, asked) for part in disks])


def _opened(part, progress):
    if part.boundary_count == 0 or _is_disk(part):
        return (part,)
    try:
        structure = conformal_structure(part, progress=progress)
    except (InvalidMesh, TopologyError, SolverError):
        return (part,)  # what is wrong with it is said where its map is made
    return islands(part, part.vertex_index[structure.edges[structure.seams]])


def _cut_to_cones(part, most_stretch, progress):
    if not _is_disk(part):
        return part
    try:
        return cut_to_cones(part, most_stretch, progress=progress)
    except (InvalidMesh, TopologyError, SolverError):
        return part  # what is wrong with it is said where its map is made


def _is_disk(part):
    return (part.genus, part.boundary_count) == (0, 1)
