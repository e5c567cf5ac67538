"""Surfaces: validated, consistently oriented polygon meshes, or intrinsic triangulations."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import FilePath, Integers, Progress, Reals
from ..core.value import Value, freeze
from ..files import formats
from . import checked_mesh
from .origin import AS_GIVEN, Refused, Repairs

if TYPE_CHECKING:
    from .quads import Quads

UNWELDED = "every face is separate: strict=False joins those that touch along a whole side"


class Surface(Value):
    """A surface of polygons, validated and triangulated. All arrays are read-only. `given_vertex_count` is the number
    of vertices of the mesh as given, and `refused` a tuple of the faces (`Refused`) that were left out, by reasons.

    Parameters
    ----------
    vertices : (#V, 3) reals; or, without faces, a mesh of trimesh, meshio, PyVista or Open3D, or any object that has
        such arrays
    faces : (#F, n) integers, or a list of lists of any sizes
    strict : refuse the whole mesh for any bad element. Else a mesh that is not a surface is cut until it is one: each
        fan of faces gets a vertex of its own, and `repairs.cuts` says where and why. Polygons and corners stay what
        they are. `refused` lists faces that are left out: those of fewer than three vertices, with coordinates that
        are not finite, at a vertex that is more than 1e9 times as far away as the mesh is large, or of parts without
        area. Faces whose sides have no neighbour and run between the same places, up to a millionth of the median side,
        in opposite directions are joined, see `repairs.joined_vertices`; so are the ends of such a side without length.
        A corner twice in a row is one. Elements are then renumbered, see `vertex_index`

    Raises
    ------
    InvalidMesh
        wrong shape, non-integer, out-of-range or negative index, NaN or infinity, a vertex that is 1e9 times too far
        away, no faces, fewer than 3 corners, a vertex twice in a face, duplicate faces, non-manifold edge or vertex,
        all area zero; names the first bad element.
    TopologyError
        if the surface is non-orientable.
    """

    def __init__(
        self, vertices: Any, faces: ArrayLike | Sequence[Sequence[int]] | None = None, strict: bool = True
    ) -> None:
        self._adopt(*checked_mesh.of_faces(vertices, faces, strict))

    @classmethod
    def from_polygons(
        cls, vertices: ArrayLike, corner_vertices: ArrayLike, face_offsets: ArrayLike, strict: bool = True
    ) -> Surface:
        """Mixed polygons: polygon f has the vertices ``corner_vertices[face_offsets[f]:face_offsets[f + 1]]``.

        Parameters
        ----------
        vertices : (#V, 3) reals
        corner_vertices : (#C,) integers
        face_offsets : (#F + 1,) integers from 0 to #C
        """
        return cls._of(*checked_mesh.of_polygons(vertices, corner_vertices, face_offsets, strict))

    @classmethod
    def from_edge_lengths(
        cls, faces: ArrayLike, edge_lengths: ArrayLike, face_edges: ArrayLike | None = None
    ) -> Surface:
        """An intrinsic surface: triangles and edge lengths alone, without positions.

        Parameters
        ----------
        faces : (#F, 3) integers
        edge_lengths : (#F, 3) reals, entry i opposite corner i
        face_edges : (#F, 3) integers, entry i the name of the edge opposite corner i; needed where two edges share
            their ends, or an edge is a loop. Without it edges are told apart by their ends.
        """
        return cls._of(checked_mesh.of_edge_lengths(faces, edge_lengths, face_edges))

    @classmethod
    def read(cls, path: FilePath, strict: bool = False, weld: bool = False, up: str | None = None) -> Surface:
        """OBJ, OFF, PLY or STL; polygons are kept, in double precision. glTF (.glb, .gltf) or 3MF: the triangles of all
        its meshes, each at its place; 3MF in millimetres.

        Parameters
        ----------
        strict : as in `Surface`, but by default a mesh is cut until it is a surface
        weld : join vertices with equal coordinates, for files in which every face has vertices of its own; what that
            leaves of a face with fewer than three corners is left out. STL files always are welded, with `strict` glTF
            and 3MF too
        up : "Y" or "Z", see `Surface.up`

        Raises
        ------
        InvalidMesh
            if the file is missing or malformed (names the line or byte), or no face of the mesh in it can be mapped.
        """
        return cls._of(*checked_mesh.of_file(path, strict, weld, up))

    def write(self, path: FilePath, uv: ArrayLike | None = None, texture: FilePath | None = None) -> None:
        """Writes OBJ or PLY with its polygons, or GLB (binary glTF) with its triangles: positions, and with `uv`,
        (#C, 2), a UV map. Positions and UVs keep double precision, in GLB single.

        texture : lies on the surface and repeats, in GLB alone: a PNG or JPEG file, which is embedded as it is, or
            "checker" for one that suits the map

        What was there stays where anything fails. Raises ValueError if the path ends with neither .obj, .ply nor .glb,
        or `uv` or `texture` does not fit; OSError if the image cannot be read, or the file not written; InvalidMesh if
        the surface is intrinsic.
        """
        formats.write(self, path, uv, texture)

    def quads(
        self,
        faces: float = 2000,
        *,
        lines: str = "whole",
        mirror: bool = False,
        marked: ArrayLike | None = None,
        evenness: float = 0.5,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Quads:
        """`Quads`: a mesh of quads of nearly one size, whose vertices lie on the surface; of each part its own, in
        proportion to the areas. Its topology is that of the surface. What was found is kept: another number is quick.

        Parameters
        ----------
        faces : about how many. A part on which fewer than 6 would lie keeps its own faces, and one that they do not fit
        lines : "whole" for edges that run along hard edges and borders, "free" for rows that run along them but may be
            cut there, "none". Where these leave no whole mesh, they are let go
        mirror : two halves that are alike, of a surface that mirrors itself
        marked : (n, 2) vertices of edges that are lines, too
        evenness : from 0 for the angles of a conformal map to 1 for quads of one size
        threads, progress : as in `conformal_structure`

        Raises ValueError for others; TopologyError where no part can have quads; Cancelled.
        Source: quads of a map that turns by quarters are Bommes, Zimmer and Kobbelt's (2009); the map is ours,
        docs/method/turns.md.

        Examples
        --------
        >>> surface = holomorph.Surface.read("examples/pretzel.obj")
        >>> quads = surface.quads(500)
        >>> print(abs(len(quads) - 500) <= 25, set(np.diff(quads.face_offsets).tolist()))
        True {4}
        """
        from .quads import MIRROR, quads  # which makes a value of its own of a surface

        return quads(self, faces, MIRROR if mirror else lines, marked, evenness, threads, progress)

    @classmethod
    def _of(cls, native, origin=AS_GIVEN):
        surface = cls.__new__(cls)
        surface._adopt(native, origin)
        return surface

    def _adopt(self, native, origin):
        self._native, self._origin = native, origin
        self.given_vertex_count: int = native.vertex_count if origin.vertex_count is None else origin.vertex_count
        self.refused: tuple[Refused, ...] = origin.refused

    def _facts(self):
        native, faces = self._native, len(self.face_offsets) - 1
        counts = (native.vertex_count, "vertices"), (faces, "faces"), (native.component_count, "component(s)")
        return [f"{count} {noun}" for count, noun in counts]

    def __getstate__(self):
        mesh = checked_mesh.arrays_of(self._native)
        return {"mesh": mesh, "origin": self._origin, "dual_vertex": self.dual_vertex}

    def __setstate__(self, state):
        freeze(state)
        self._adopt(checked_mesh.native_of(state["mesh"]), state["origin"])
        self.dual_vertex = state["dual_vertex"]

    @cached_property
    def vertices(self) -> Reals | None:
        """(#V, 3) positions; None for an intrinsic surface."""
        return None if self._native.intrinsic else self._native.vertices

    @cached_property
    def corner_vertices(self) -> Integers:
        """(#C,) vertex of each polygon corner."""
        return self._native.corner_vertices

    @cached_property
    def face_offsets(self) -> Integers:
        """(#F + 1,) first corner of each polygon."""
        return self._native.face_offsets

    @cached_property
    def triangles(self) -> Integers:
        """(#T, 3) vertices, consistently oriented."""
        return self._native.triangles

    @cached_property
    def triangle_corners(self) -> Integers:
        """(#T, 3) polygon corner at each triangle corner."""
        return self._native.triangle_corners

    @cached_property
    def triangle_faces(self) -> Integers:
        """(#T,) polygon of each triangle."""
        return self._native.triangle_faces

    @cached_property
    def vertex_index(self) -> Integers:
        """(#V,) index of each vertex in the mesh as given, of which this may be a component. Where that was cut,
        several may be copies of one; of those that were joined, the lowest is named."""
        return self._index(self._origin.vertex_index, self._native.vertex_count)

    @cached_property
    def face_index(self) -> Integers:
        """(#F,) index of each face in the mesh as given."""
        return self._index(self._origin.face_index, len(self.face_offsets) - 1)

    @cached_property
    def corner_index(self) -> Integers:
        """(#C,) index of each corner in the mesh as given."""
        return self._index(self._origin.corner_index, len(self.corner_vertices))

    @staticmethod
    def _index(given, count):
        return arrays.frozen(np.arange(count, dtype=np.int32)) if given is None else given

    dual_vertex: Integers | None = None
    """(#V,) of a `double_cover`: the same vertex in the other copy, itself on the boundary between them. None of other
    surfaces."""

    @property
    def components(self) -> tuple[Surface, ...]:
        """Tuple of the connected components, ordered by their first face, without isolated vertices."""
        # Not kept where it is itself: a reference to itself would keep it until garbage collection.
        return (self,) if self._is_component else self._parts

    @cached_property
    def _is_component(self):
        return self._native.component_count == 1 and not len(self._native.isolated_vertices)

    @cached_property
    def _part(self):
        """The core's value of a component."""
        return _native.WholePart(self._native, self.up, [])

    @cached_property
    def _tilers(self):
        """The core's tilings of a component, kept for other numbers of quads."""
        return _native.Tilers(self._part)

    @cached_property
    def _parts(self):
        origin, count = self._origin, self.given_vertex_count
        parts = self._native.components()
        return tuple(Surface._of(part.surface, origin.of_component(part, count)) for part in parts)

    @cached_property
    def _topology(self):
        self.require_connected()
        return self._native.topology()

    def require_connected(self) -> None:
        """Raises TopologyError if there are several components."""
        count = self._native.component_count
        if count != 1:
            hint = f"; {UNWELDED}" if self.is_unwelded else ""
            raise TopologyError(f"the surface has {count} connected components; take one of surface.components{hint}")

    @property
    def euler_characteristic(self) -> int:
        """#V - #E + #F, isolated vertices not counted."""
        self.require_connected()
        return self._native.euler_characteristic()

    @cached_property
    def boundary_count(self) -> int:
        """Number of boundary loops."""
        return self._topology.boundary_count

    @cached_property
    def area(self) -> float:
        """Sum of the triangles' areas, in the square of the positions' unit."""
        return self._native.area()

    @cached_property
    def genus(self) -> int:
        """Number of handles."""
        return self._topology.genus

    @cached_property
    def repairs(self) -> Repairs:
        """The `Repairs`: what was wrong with the input, and handled inside."""
        return self._origin.repairs(self._native)

    @property
    def up(self) -> str:
        """The axis of the positions that points up, so that maps stand upright: "Y" in OBJ and glTF files, else "Z"."""
        return self._origin.up

    def _standing_as(self, other):
        """This surface, made from another one: the same axis points up."""
        self._origin = self._origin._replace(up=other.up)
        return self

    @property
    def is_whole(self) -> bool:
        """Whether elements are numbered as in the mesh as given."""
        return self._origin.face_index is None

    @property
    def is_unwelded(self) -> bool:
        """Whether there are faces, and every one is apart: they may touch, but share no vertices."""
        return self._native.component_count == len(self.face_offsets) - 1 > 1
