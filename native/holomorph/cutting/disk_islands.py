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
