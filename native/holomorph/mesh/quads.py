"""A mesh of quads over a surface."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._native import InvalidMesh, SolverError, TopologyError
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.progress import scaled
from ..core.value import Value, counted
from .checks import check_name, check_threads, checked_evenness, real_number
from .edges import edge_keys, polygon_sides
from .origin import edges_on_part

if TYPE_CHECKING:
    from .surface import Surface

FEWEST = 6  # faces: a cube
LINES = ("whole", "free", "none")
MIRROR = "mirror"
REGULAR = 4  # edges at a vertex inside


@dataclass(frozen=True, eq=False, repr=False)
class Quads(Value):
    """Result of `Surface.quads`: a mesh of quads, whose vertices lie on the surface. All arrays are read-only.

    positions : (#V, 3) of the vertices
    corner_vertices, face_offsets : (#C,) and (#F + 1,) the polygons, as in `Surface`, oriented as its faces. Those of
        closed parts are quads; where rows are cut off at a border, or folded, there are others
    uv : (#C, 2) in which each quad is a unit square with whole corners, continued across seams in a polygon
    places : (#V, 3) vertices of the surface as given: those of the triangle that a vertex lies in
    weights : (#V, 3) barycentric coordinates there
    faces : (#V,) polygon of the surface that has this triangle
    lines : of each part, what its rows end at or run along: "whole", "free", "mirror" or "none"; "" where it is `kept`
    kept : {part: why it has no quads, and keeps its own polygons}, by their indices in `Surface.components`
    """

    positions: Reals
    corner_vertices: Integers
    face_offsets: Integers
    uv: Reals
    places: Integers
    weights: Reals
    faces: Integers
    lines: tuple[str, ...]
    kept: Mapping[int, str]

    def __len__(self) -> int:
        return len(self.face_offsets) - 1

    def _facts(self):
        others = int((np.diff(self.face_offsets) != 4).sum())
        told = [f"{others} of them no quads"] if others else []
        return [counted(len(self), "face"), *told, counted(len(self.irregular), "irregular point")]

    @property
    def sentence(self) -> str:
        """What was made, for people."""
        return ", ".join(self._facts())

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences about the parts that are `kept`, one for each reason."""
        return tuple(
            f"{counted(count, 'part')} {'keeps its' if count == 1 else 'keep their'} own faces: {reason}"
            for reason, count in Counter(self.kept.values()).items()
        )

    def of(self, values: ArrayLike) -> NDArray[Any]:
        """(#V, ...) values at the vertices, of values at the vertices of the surface as given, such as its positions in
        another pose."""
        return np.einsum("ni,ni...->n...", self.weights, np.asarray(values)[self.places])

    @cached_property
    def irregular(self) -> Integers:
        """(k,) vertices inside with another number of edges than four."""
        count = len(self.positions)
        sides = polygon_sides(self)
        _, first, times = np.unique(edge_keys(sides, count), return_index=True, return_counts=True)
        ends = sides[first]
        edges = np.bincount(ends.ravel(), minlength=count)
        edges[ends[times == 1].ravel()] = REGULAR  # on the border
        return arrays.frozen(np.flatnonzero((edges != REGULAR) & (edges > 0)))


def quads(
    surface: Surface,
    faces: float,
    lines: str,
    marked: ArrayLike | None,
    evenness: float,
    threads: int | None,
    progress: Progress | None,
) -> Quads:
    """See `Surface.quads`; lines : "mirror" besides."""
    chosen = np.empty((0, 2), np.int32) if marked is None else arrays.integer(marked, "marked", 2, (2,))
    if not real_number(faces, "faces", positive=True) >= FEWEST:
        raise ValueError(f"faces is {faces:g}; at least {FEWEST} are needed")
    check_name(lines, (*LINES, MIRROR), "lines")
    options = {"evenness": checked_evenness(evenness), "threads": check_threads(threads)}
    areas = np.array([part.area for part in surface.components])
    shares = np.divide(areas, areas.sum(), out=np.zeros(len(areas)), where=areas.sum() > 0)
    made, kept, done = [], {}, 0.0
    for k, (part, share) in enumerate(zip(surface.components, shares)):
        own = scaled(progress, done, min(done + share, 1.0))
        done += share
        try:
            if faces * share < FEWEST:
                raise TopologyError("fewer than six quads would lie there: take more faces")
            asked = faces * share, lines, np.asarray(edges_on_part(part, chosen), np.int32)
            made.append(_found(part, part._tilers.quads(*asked, **options, progress=own)))
        except (InvalidMesh, TopologyError, SolverError) as error:
            kept[k] = str(error)
            made.append(_as_it_is(part))
    if len(kept) == len(made):
        raise TopologyError(f"no part can have quads: {kept[int(shares.argmax())]}")  # the largest one
    return _joined(made, kept)


def _found(part, found):
    """(positions, corner vertices, numbers of corners, uv, places, weights, faces, lines) of the core's quads."""
    cells = found.cells
    corners, weights = part.triangles[cells.triangles], cells.barycentric
    positions, places = np.einsum("ni,nij->nj", weights, part.vertices[corners]), part.vertex_index[corners]
    mesh = positions, cells.corner_vertices, np.diff(cells.offsets), cells.corner_points
    return *mesh, places, weights, part.face_index[part.triangle_faces[cells.triangles]], found.lines


def _as_it_is(part):
    """The same of a part with its own polygons, each a point in the plane."""
    places = np.repeat(part.vertex_index[:, None], 3, axis=1)
    weights = np.zeros(places.shape)
    weights[:, 0] = 1
    uv = np.zeros((len(part.corner_vertices), 2))
    faces, sizes = np.zeros(len(places), np.int64), np.diff(part.face_offsets)
    faces[part.corner_vertices] = np.repeat(part.face_index, sizes)
    return part.vertices, part.corner_vertices, sizes, uv, places, weights, faces, ""


def _joined(parts, kept):
    """The `Quads` of all parts."""
    positions, corners, sizes, uv, places, weights, faces, lines = zip(*parts)
    begin = np.cumsum([0, *map(len, positions[:-1])])
    values = {
        "positions": np.concatenate(positions),
        "corner_vertices": np.concatenate([own + first for own, first in zip(corners, begin)]).astype(np.int32),
        "face_offsets": np.concatenate([[0], np.cumsum(np.concatenate(sizes))]).astype(np.int32),
        "uv": np.concatenate(uv),
        "places": np.concatenate(places),
        "weights": np.concatenate(weights),
        "faces": np.concatenate(faces),
    }
    return Quads(**{name: arrays.frozen(array) for name, array in values.items()}, lines=lines, kept=kept)
