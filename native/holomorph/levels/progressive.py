"""Progressive meshes: a small base mesh and a sequence of vertex splits that rebuilds the original exactly."""

from __future__ import annotations

import io
import math
import zlib
from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._native import InvalidMesh
from ..core import arrays
from ..core.array_types import FilePath, Integers, Progress
from ..core.value import Value, quoted
from ..files import whole_file
from ..forms.results import result
from ..forms.structure import BoundedStructure, ConformalStructure
from ..mesh.checked_mesh import naming
from ..mesh.checks import as_float, check_memory_limit, check_name, check_options, check_thresholds, check_type
from ..mesh.origin import Origin
from ..mesh.surface import Surface
from . import levels

ORDERS = ("quadric", "independent")
SPLIT = np.dtype(
    [
        ("v_s", np.int32),
        ("v_t", np.int32),
        ("v_l", np.int32),
        ("v_r", np.int32),
        ("position", np.float64, 3),
        ("vertex", np.int32),
        ("triangles", np.int32, 2),
        ("slots", np.uint8, 2),
        ("corners", np.int32, (2, 3)),
    ]
)
ROWS = {
    "base_triangles": (np.int32, (3,)),
    "split_vertices": (np.int32, (3,)),
    "split_slots": (np.uint8, (2,)),
    "positions": (np.float64, (3,)),
    "vertex_index": (np.int32, ()),
    "triangle_index": (np.int32, ()),
    "triangle_corners": (np.int32, (3,)),
    "face_offsets": (np.int32, ()),
}
"""The type and shape of one row of each."""

# What NumPy and zipfile raise for bytes that are no file of arrays: RuntimeError also for ways of compression that they
# do not know, MemoryError for what the first bytes of an array ask for.
DAMAGED = ValueError, KeyError, EOFError, OSError, RuntimeError, MemoryError, BadZipFile, zlib.error


class ProgressiveMesh(Value):
    """The surface's triangulation as a base mesh and vertex splits (Gu, Wang, Yau 2003, section 3; Hoppe 1996,
    doi:10.1145/237170.237216), down to a mesh in which no edge can be collapsed: 4 triangles for a sphere, at most 20
    for a torus. Every level is a manifold of the same topology; vertices never move, and those of the boundary are
    collapsed along it only.

    Vertices of the levels are numbered base first, then in the order of the splits; triangles likewise, the left one
    first. So those of a level are the first ones of every finer level. Polygons with more than three corners are cut
    into triangles in the levels, and restored as they were.

    Parameters
    ----------
    surface : Surface, with positions; of one or several components
    corner_data : (#C, ...) numbers or booleans, one row per polygon corner; kept bit for bit
    order : which edges are collapsed first: "quadric", by quadric error (Garland & Heckbert 1997,
        doi:10.1145/258734.258849), for levels of detail; "independent", several times faster, by rounds in which
        vertices that are pairwise not adjacent are collapsed along their shortest edges
    kept : vertices that every level has, such as the cones of a map that turns
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Raises
    ------
    InvalidMesh
        if the surface is intrinsic, if its triangulated polygons have two edges with the same ends even after
        diagonals are flipped, or if `corner_data` or `kept` do not fit the surface.
    Cancelled
        if `progress` returned False
    """

    def __init__(
        self,
        surface: Surface,
        *,
        corner_data: ArrayLike | None = None,
        order: str = "quadric",
        kept: ArrayLike = (),
        progress: Progress | None = None,
    ) -> None:
        check_type(surface, Surface)
        check_name(order, ORDERS, "order")
        self.corner_data = None if corner_data is None else _checked(corner_data, len(surface.corner_vertices))
        vertices = arrays.integer(kept if np.size(kept) else np.empty(0, np.int64), "kept")
        if len(vertices) and not 0 <= vertices.min() <= vertices.max() < surface._native.vertex_count:
            raise InvalidMesh("kept names a vertex that is not in the surface")
        self._native = _native.ProgressiveMesh.make(surface._native, order, vertices.tolist(), progress)

    @classmethod
    def load(cls, path: FilePath) -> ProgressiveMesh:
        """Reads what `save` wrote.

        Raises
        ------
        InvalidMesh
            if the file is missing or damaged; every count, index and split is checked.
        """
        mesh = cls.__new__(cls)
        with naming(path):
            mesh.__setstate__(_read(path))
        return mesh

    def save(self, path: FilePath) -> None:
        """Writes one .npz file, whatever its name: the arrays of the base, of the splits and of their attributes."""
        content = io.BytesIO()
        np.savez(content, **self.__getstate__())
        whole_file.write(path, content.getbuffer())

    def _facts(self):
        return [f"{len(self._native.base_triangles)} to {len(self._native.triangle_index)} triangles"]

    def __getstate__(self):
        state = {name: getattr(self._native, name) for name in ROWS}
        return state if self.corner_data is None else {**state, "corner_data": self.corner_data}

    def __setstate__(self, state):
        self._native = _native_of(state)
        data = state.get("corner_data")
        self.corner_data = None if data is None else _checked(data, self._corner_count)

    @cached_property
    def base(self) -> Surface:
        """The coarsest level, a `Surface` of triangles."""
        return self._level(0)

    @cached_property
    def splits(self) -> NDArray[np.void]:
        """Structured array of the vertex splits, coarsest first.

        v_s, v_t, v_l, v_r : vertices, v_t the new one; v_l or v_r is -1 where v_s v_t is on the boundary. The triangles
            {v_s, v_t, v_l} and {v_t, v_s, v_r} are added, and those counter-clockwise from v_r to v_l around v_s move
            to v_t
        position : of v_t; v_s does not move
        vertex : index of v_t in the original
        triangles : indices of the left and the right triangle in the original triangulation, -1 where there is none
        slots : the corner of the left triangle that is v_s, that of the right one that is v_t
        corners : polygon corners of the original at the corners of both triangles, whose `corner_data` they have
        """
        v_s, v_l, v_r = self._native.split_vertices.T
        splits = np.empty(len(v_s), SPLIT)
        first, count = self._native.base_vertex_count, len(v_s)
        splits["v_s"], splits["v_l"], splits["v_r"] = v_s, v_l, v_r
        splits["v_t"] = np.arange(first, first + count)
        splits["slots"] = self._native.split_slots
        splits["position"] = self._native.positions[first : first + count]
        splits["vertex"] = self._native.vertex_index[first : first + count]
        present = np.stack([v_l, v_r], axis=1) >= 0
        triangle = len(self._native.base_triangles) + np.cumsum(present.ravel()).reshape(present.shape) - 1
        triangle = np.where(present, triangle, 0)
        splits["triangles"] = np.where(present, self._native.triangle_index[triangle], -1)
        splits["corners"] = np.where(present[:, :, None], self._corners[triangle], -1)
        return arrays.frozen(splits)

    @cached_property
    def _corners(self):
        return self._native.triangle_corners

    @cached_property
    def _faces(self):
        """The original polygon of each triangle."""
        offsets = self._native.face_offsets
        if not len(offsets):
            return self._native.triangle_index
        return np.repeat(np.arange(len(offsets) - 1, dtype=np.int32), np.diff(offsets) - 2)[self._native.triangle_index]

    corner_data: NDArray[Any] | None
    """The rows given for the original's polygon corners; None if there were none; see `level_corner_data`."""

    # Defined in levels.py.
    level_corner_data = levels.level_corner_data
    levels_of_detail = levels.levels_of_detail
    lift_loops = levels.lift_loops
    pull_back_forms = levels.pull_back_forms

    @property
    def _corner_count(self):
        offsets = self._native.face_offsets
        return int(offsets[-1]) if len(offsets) else self._corners.size

    def _split_count(self, n_faces):
        if math.isnan(as_float(n_faces)):
            raise ValueError(f"n_faces is {quoted(n_faces)}; a number of triangles is needed")
        return self._native.split_count(int(max(0, min(n_faces, 2**62))))

    def _level(self, splits):
        level = self._native.level(splits)
        vertices, faces = self._native.base_vertex_count + splits, len(level.triangles)
        origin = Origin(
            self._native.vertex_index[:vertices],
            arrays.frozen(self._faces[:faces]),
            arrays.frozen(self._corners[:faces].ravel()),
        )
        return Surface._of(level, origin)

    def level(self, n_faces: int) -> Surface:
        """The finest level with at most `n_faces` triangles, or the base if that has more.

        Returns
        -------
        Surface
            Of triangles; its `vertex_index`, `face_index` and `corner_index` say which vertex, polygon and polygon
            corner of the original each element comes from.
        """
        return self._level(self._split_count(n_faces))

    def restore(self) -> Surface:
        """The original surface, rebuilt from the base by all the splits: positions, polygons and the order of their
        corners, bit for bit."""
        return Surface._of(self._native.restored())

    def conformal_structure(
        self,
        n_faces: int,
        *,
        solver: str = "auto",
        thresholds: Sequence[float] | None = None,
        threads: int | None = None,
        memory_limit: float | None = None,
        progress: Progress | None = None,
    ) -> ConformalStructure | BoundedStructure:
        """The conformal structure of ``level(n_faces)``, with the same homology classes at every level (paper section
        9): the loops of the base are lifted through the splits, and the classes dual to them pulled back. The
        intersection matrix and the canonical basis, with boundary the pairing, are equal at all levels, so period
        matrices and forms can be compared, and textures stay in place from level to level. Boundary loops have the
        order of the base's at every level.

        Parameters and errors are those of `holomorph.conformal_structure`.

        Returns
        -------
        ConformalStructure of a closed surface of genus >= 1, BoundedStructure of one with boundary
            Its `surface` is ``level(n_faces)``.
        """
        options = {"solver": solver, "thresholds": thresholds, "threads": threads, "memory_limit": memory_limit}
        again = partial(self.conformal_structure, n_faces, **options)
        threads, memory_limit = check_options(solver, threads), check_memory_limit(memory_limit)
        thresholds = check_thresholds(thresholds, solver)
        kind = BoundedStructure if self.base.boundary_count else ConformalStructure
        splits = self._split_count(n_faces)
        surface = self._level(splits)
        level = self._native, splits, surface._native
        if solver == "paper":
            native = _native.paper_structure_of_level(*level, thresholds, threads, memory_limit, progress)
        else:
            native = _native.conformal_structure_of_level(*level, solver, threads, memory_limit, progress)
        return result(kind, surface, surface, native, threads).computed_by(again)

    def vertex_map(self, n_faces: int) -> Integers:
        """(#V,) vertex of ``level(n_faces)`` that each vertex of the original was collapsed into; -1 for isolated ones.
        It takes edges of the original to edges or single vertices of the level."""
        return arrays.frozen(self._map_of_original(self._split_count(n_faces)))

    def _map_of_original(self, splits):
        mapped = self._native.vertex_map(splits)
        result = np.full(len(self._native.vertex_index), -1, np.int32)
        result[self._native.vertex_index[: len(mapped)]] = mapped
        return result


def _native_of(given):
    """The native progressive mesh of its arrays; every count, index and split is checked. Raises InvalidMesh"""
    for name, (kind, shape) in ROWS.items():
        if name not in given:
            raise InvalidMesh(f"the progressive mesh has no array {name}")
        array = given[name]
        if array.dtype.newbyteorder("=") != kind or array.ndim == 0 or array.shape[1:] != shape:
            raise InvalidMesh(f"the progressive mesh is damaged: {name} has the wrong type or shape")
    if len(given["split_vertices"]) != len(given["split_slots"]):
        raise InvalidMesh("the progressive mesh is damaged: there are not as many slots as splits")
    return _native.ProgressiveMesh.of_arrays(**{name: given[name] for name in ROWS})


def _read(path):
    """{name: array}. Raises InvalidMesh for what is no such file"""
    try:
        content = whole_file.read(path)
    except OSError as error:
        raise InvalidMesh(error.strerror) from error
    try:
        with ZipFile(io.BytesIO(content)) as file:
            # Nothing is compressed: a small file does not take much memory.
            if sum(member.file_size for member in file.infolist()) > len(content):
                raise BadZipFile("it is compressed")
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return dict(file)
    except DAMAGED as error:
        raise InvalidMesh(f"it is no undamaged .npz file of a progressive mesh ({error})") from error


def _checked(corner_data, corner_count):
    """A copy, read-only."""
    rows = np.array(corner_data, order="C")
    if rows.dtype.kind not in "biufc":
        raise InvalidMesh(f"corner_data has the type {rows.dtype}; numbers or booleans are needed")
    if rows.ndim == 0 or len(rows) != corner_count:
        raise InvalidMesh(f"corner_data has {len(rows) if rows.ndim else 0} rows for {corner_count} polygon corners")
    return arrays.frozen(rows)
