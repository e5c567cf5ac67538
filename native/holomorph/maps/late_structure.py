"""The structure of a part with so many forms that these are solved for only when they are asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ..core import arrays
from ..core.array_types import Integers, Progress
from ..core.value import Value, counted
from ..mesh.surface import Surface
from .automatic_structure import AnyStructure, automatic_structure

# Seconds of one processor that all real forms of a part may take, and besides for each of its triangles. Poles and a
# map of so many forms take ten times as long.
MOST_SECONDS, MOST_PER_TRIANGLE = 0.25, 2e-5
# Seconds for a value of a form on an edge, for a product of two of these, and for a product in a dense matrix of all.
SOLVED, MULTIPLIED, DENSE = 3e-8, 5e-11, 2e-9


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
        return f"{form_count(self.part)} forms, too many to solve for"

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


def form_count(part: Surface) -> int:
    """n, the number of holomorphic forms of a surface without poles."""
    return part.genus if part.boundary_count == 0 else 2 * part.genus + part.boundary_count - 1


def form_seconds(part: Surface) -> float:
    """About how long all forms of a connected part take, on one processor."""
    count, edges = 2 * form_count(part), 1.5 * len(part.triangles)
    return count * edges * (SOLVED + count * MULTIPLIED) + count**3 * DENSE


def late_structure(part: Surface, threads: int | None = None) -> LateStructure | None:
    """The `LateStructure` of a connected part; None where its forms take less than that, or it has no positions,
    and so no map without them."""
    most = MOST_SECONDS + MOST_PER_TRIANGLE * len(part.triangles)
    if part.vertices is None or form_seconds(part) < most:
        return None
    return LateStructure(part, part, threads)
