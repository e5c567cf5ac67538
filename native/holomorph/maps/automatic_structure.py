"""Which structure a part gets, by the choices and by its topology, and whether it is solved for at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, TypeAlias

from numpy.typing import ArrayLike

from .. import _native
from ..core.array_types import Complexes, Integers, Progress
from ..core.arrays import frozen, integer
from ..core.value import Value, counted
from ..forms.log_map import PoleStructure, log_map
from ..forms.results import result
from ..forms.structure import BOUNDARIES, BoundedStructure, ConformalStructure, conformal_structure
from ..mesh.checks import check_thresholds, only_component
from ..mesh.edges import around_boundary
from ..mesh.surface import Surface
from ..plane.cut import cut_along
from ..plane.disk import PlaneMap, default_disk_map, disk_map, disk_structure_of, free_boundary_map, rectangle_map
from ..tiling.request import part_of

AnyStructure: TypeAlias = ConformalStructure | BoundedStructure | PoleStructure | PlaneMap
Vertices: TypeAlias = Sequence[int] | Integers


def automatic_structure(
    surface: Surface,
    *,
    poles: Vertices | None = None,
    residues: Sequence[complex] | Complexes | None = None,
    corners: Vertices | None = None,
    boundary: str = "natural",
    cuts: ArrayLike | None = None,
    solver: str = "auto",
    thresholds: Sequence[float] | None = None,
    threads: int | None = None,
    memory_limit: float | None = None,
    progress: Progress | None = None,
) -> AnyStructure:
    """The structure of one connected surface of any kind. Without a choice: `conformal_structure` where there are
    holomorphic forms, `log_map` of a sphere, and of a disk the rectangle with clear corners, the unit disk, or what is
    most even.

    Parameters
    ----------
    corners : list of four boundary vertices in any order: `rectangle_map` with these
    poles, residues : `disk_map` of a disk with one pole and without residues; else `log_map` with these
    boundary : "natural", "double_cover" as in `conformal_structure`, or "free" for `free_boundary_map`
    cuts : (#S, 2) vertices of edges, of `cut_along`
    solver, thresholds, threads, memory_limit, progress : as in `conformal_structure`

    The first of corners, poles and boundary that is given counts; an empty list counts as not given. Raises what these
    functions raise.
    Source: that of the function chosen; the choice among maps of disks is ours, docs/method/disks.md.

    Examples
    --------
    >>> roof = [(0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
    >>> disk = holomorph.Surface(roof, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)])
    >>> print(holomorph.automatic_structure(disk).map_kind)
    rectangle
    """
    check_thresholds(thresholds, solver)
    options = {"solver": solver, "threads": threads, "progress": progress}
    if corners is not None and len(corners):
        made = rectangle_map(surface, around_boundary(surface, integer(corners, "corners")), **options)
    elif poles is not None and len(poles):
        made = _with_poles(surface, poles, residues, memory_limit, options)
    elif boundary == "free":
        made = free_boundary_map(surface, **options)
    else:
        made = _by_topology(surface, boundary, thresholds, memory_limit, options)
    return made if cuts is None else cut_along(made, cuts)


def _with_poles(surface, poles, residues, memory_limit, options):
    component = only_component(surface)
    is_disk = (component.genus, component.boundary_count) == (0, 1)
    if is_disk and len(poles) == 1 and residues is None:
        return disk_map(surface, int(poles[0]), **options)
    return log_map(surface, poles, residues, memory_limit=memory_limit, **options)


def _by_topology(surface, boundary, thresholds, memory_limit, options):
    component = only_component(surface)
    topology = component.genus, component.boundary_count
    if topology == (0, 1) and boundary == "natural":
        return default_disk_map(surface, **options)
    if topology == (0, 0) and boundary in BOUNDARIES:
        return log_map(surface, memory_limit=memory_limit, **options)
    more = {"boundary": boundary, "thresholds": thresholds, "memory_limit": memory_limit}
    return conformal_structure(surface, **more, **options)


def structure_of(core, surface, threads):
    """The structure of a connected surface that the core made by itself."""
    component = only_component(surface)
    if core.kind in ("forms", "strip"):
        kind = BoundedStructure if component.boundary_count else ConformalStructure
        made = result(kind, surface, component, core.solved, threads)
        vars(made)["_core"] = core
    else:
        made = disk_structure_of(core, surface, component, threads)
    return made.computed_by(partial(automatic_structure, surface, threads=threads))


@dataclass(frozen=True, eq=False, repr=False)
class LateStructure(Value):
    """Stands for the `automatic_structure` of a part, which is made when first asked for more than is here: of one with
    so many forms that these take long, or with none.

    surface : whose vertices results name; part : what is solved on
    """

    surface: Surface
    part: Surface
    threads: int | None = None

    form_count = 0  # that get maps of their own

    @property
    def description(self) -> str:
        """What there is, in one phrase."""
        if not self.is_large:
            return self.made.description
        return f"{_native.form_count(part_of(self.part))} forms, too many to solve for"

    @property
    def is_large(self) -> bool:
        """Whether it takes long to make."""
        return _native.has_too_many_forms(part_of(self.part))

    @property
    def edges(self) -> Integers:
        """(#E, 2) vertices, as a structure has them."""
        edges = self.part._native.edges
        return edges if self.part is self.surface else frozen(self.part.vertex_index[edges])

    def prepare_uv(self, progress: Progress | None = None) -> None:
        """Nothing is done ahead."""

    def of_copy(self, component: Surface) -> LateStructure:
        """The structure of a copy."""
        return LateStructure(component, component, self.threads)

    @cached_property
    def made(self) -> AnyStructure:
        """The structure itself."""
        return replace(automatic_structure(self.part, threads=self.threads), surface=self.surface)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name in ("surface", "part", "threads"):  # as when a pickle is read
            raise AttributeError(name)
        return getattr(self.made, name)

    def _facts(self):
        return [self.description, counted(len(self.part.triangles), "triangle")]


def late_structure(part: Surface, threads: int | None = None) -> LateStructure | None:
    """The `LateStructure` of a connected part; None where it has forms that take less than that, or it has no
    positions, and so no map without them."""
    core = part_of(part)
    is_late = _native.is_outline(core) or _native.has_too_many_forms(core)
    return LateStructure(part, part, threads) if is_late else None
