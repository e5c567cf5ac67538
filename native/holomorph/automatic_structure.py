"""Which structure a part gets without a choice, by its topology."""

from typing import TypeAlias

from .array_types import Progress
from .bounded import BoundedStructure
from .checks import only_component
from .closed import ConformalStructure
from .disk import default_disk_map
from .log_map import log_map
from .plane_maps import DiskMap, FreeBoundaryMap, RectangleMap, TriangleMap
from .pole_structure import PoleStructure
from .structure import BOUNDARIES, conformal_structure
from .surface import Surface

AnyStructure: TypeAlias = (
    ConformalStructure | BoundedStructure | PoleStructure | DiskMap | FreeBoundaryMap | RectangleMap | TriangleMap
)


def automatic_structure(
    surface: Surface,
    *,
    boundary: str = "natural",
    solver: str = "auto",
    threads: int | None = None,
    memory_limit: float | None = None,
    progress: Progress | None = None,
) -> AnyStructure:
    """The structure of one connected surface of any kind: `conformal_structure` where there are holomorphic forms,
    `log_map` of a sphere, and of a disk the rectangle with clear corners, the unit disk, or what is most even.

    Parameters, errors : as in `conformal_structure`
    """
    component = only_component(surface)
    topology, options = (component.genus, component.boundary_count), {"solver": solver, "threads": threads}
    if topology == (0, 1) and boundary == "natural":
        return default_disk_map(surface, progress=progress, **options)
    if topology == (0, 0) and boundary in BOUNDARIES:
        return log_map(surface, memory_limit=memory_limit, progress=progress, **options)
    return conformal_structure(surface, boundary=boundary, memory_limit=memory_limit, progress=progress, **options)
