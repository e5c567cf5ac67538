"""The structure of a part with so many forms that these are solved for only when they are asked for, or with none."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Progress
from ..core.value import Value, counted
from ..mesh.surface import Surface
from ..tiling.request import part_of
from .automatic_structure import AnyStructure, automatic_structure


@dataclass(frozen=True, eq=False, repr=False)
class LateStructure(Value):
    """Stands for the `automatic_structure` of a part, which is made when first asked for more than is here.

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
        return edges if self.part is self.surface else arrays.frozen(self.part.vertex_index[edges])

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
