# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's meshes, images and arrays: the only module that calls foreach_get and foreach_set.

Positions are double precision on our side and float32 on Blender's. Corners are in the order of
the polygons, which before Blender 4.0 need not be the order of the mesh's loops.
"""

import zlib
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

from .. import compatibility, native
from ..compatibility import Values

SEAM, SHARP = "use_seam", "use_edge_sharp"  # marks of edges
KEYED = 100_000  # vertices up to which all positions are in a key: a panel makes one whenever it is drawn
SAMPLED = 1000  # vertices of a larger mesh that are


@dataclass(eq=False)
class Polygons:
    """A mesh's polygons as arrays, or some of them; `loops` gives the loop of each corner, or None where they agree."""

    vertices: np.ndarray  # (#V,3) float64, in the object's frame without its translation
    corner_vertices: np.ndarray  # (#C,) int32
    face_offsets: np.ndarray  # (#F+1,) int32
    loops: np.ndarray | None
    faces: np.ndarray | None = None  # (#F,) which polygons of the mesh they are, None for all

    @property
    def face_count(self):
        return len(self.face_offsets) - 1

    def surface(self, strict=True):
        """The `holomorph.Surface` of them, or the one that they become when they are cut."""
        arrays = self.vertices, self.corner_vertices, self.face_offsets
        return native.load().Surface.from_polygons(*arrays, strict=strict)

    def share(self, surface):
        """Takes the arrays of the surface that was made of these, where they are equal: one copy of them is left."""
        if surface.is_whole:
            self.vertices, self.corner_vertices = surface.vertices, surface.corner_vertices
            self.face_offsets = surface.face_offsets

    def has_faces_of(self, other):
        """Whether the faces are the same, as where modifiers move vertices alone."""
        same = np.array_equal(self.face_offsets, other.face_offsets)
        return same and np.array_equal(self.corner_vertices, other.corner_vertices)

    def has_corner_in(self, faces):
        """(#C,) bool: whether each corner is one of these faces, indices or a mask."""
        is_one = np.zeros(self.face_count, bool)
        is_one[faces] = True
        return np.repeat(is_one, np.diff(self.face_offsets))

    def of_faces(self, mask):
        """Those of some of the faces, (#F,) bool."""
        faces, corners = (np.flatnonzero(one).astype(np.int32) for one in (mask, self.has_corner_in(mask)))
        offsets = np.zeros(len(faces) + 1, np.int32)
        np.cumsum(np.diff(self.face_offsets)[faces], out=offsets[1:])
        loops = corners if self.loops is None else self.loops[corners]
        return Polygons(self.vertices, self.corner_vertices[corners], offsets, loops, faces)

    def of_corners(self, values):
        """Values of the mesh's loops in the order of the corners."""
        return values if self.loops is None else values[self.loops]

    def equals(self, other):
        """Whether geometry and topology are the same, whatever the order of the loops; never with a NaN."""
        return self.has_faces_of(other) and np.array_equal(self.vertices, other.vertices)


def read_values(values):
    """(n,) or, for a width above 1, (n, width) array of `compatibility.Values`."""
    array = np.empty(len(values.elements) * values.width, values.dtype)
    values.elements.foreach_get(values.name, array)
    return array if values.width == 1 else array.reshape(-1, values.width)


def write_values(values, array):
    """The reverse of `read_values`."""
    values.elements.foreach_set(values.name, np.ascontiguousarray(array, values.dtype).ravel())


def read_indices(values):
    """Vertices, loops or lengths as int32, which they fit: Blender has at most 2^31 of each."""
    return read_values(values).view(np.int32)


def read_polygons(mesh, linear):
    """Copies the polygons out of `mesh`, positions multiplied by the 3x3 matrix `linear`.

    The object's rotation and translation do not change angles, its scale and shear do. The library
    checks the arrays: Blender's own ``validate`` would change the mesh.
    """
    positions, corners = compatibility.polygon_values(mesh)
    vertices, corner_vertices = read_values(positions).astype(np.float64), read_indices(corners)
    if not np.array_equal(linear, np.eye(3)):
        with np.errstate(all="ignore"):  # the library names the vertex of a NaN
            vertices = vertices @ np.asarray(linear, np.float64).T
    starts, sizes = (read_indices(Values(mesh.polygons, f"loop_{name}", np.uint32)) for name in ("start", "total"))
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    loops = None
    if not np.array_equal(starts, offsets[:-1]) or offsets[-1] != len(corner_vertices):
        loops = np.repeat(starts - offsets[:-1], sizes) + np.arange(offsets[-1], dtype=np.int32)
        corner_vertices = corner_vertices[loops]
    return Polygons(vertices, corner_vertices, offsets, loops)


def read(obj, mask=None):
    """The polygons as they are seen: with the object's scale, without modifiers; some of them for a mask."""
    polygons = read_polygons(obj.data, linear(obj))
    return polygons if mask is None else polygons.of_faces(mask)


def linear(obj):
    """(3, 3) linear part of the object's matrix, without its translation."""
    return np.array(obj.matrix_world, np.float64)[:3, :3]


def shape_key(mesh):
    """A number that changes when the mesh is edited: out of its counts and positions."""
    counts = [len(mesh.vertices), len(mesh.edges), len(mesh.polygons), len(mesh.loops)]
    if counts[0] <= KEYED:
        positions = read_values(compatibility.position_values(mesh))
    else:
        positions = np.array([mesh.vertices[i].co for i in range(0, counts[0], counts[0] // SAMPLED)], np.float32)
    return zlib.crc32(positions.tobytes(), zlib.crc32(np.array(counts).tobytes()))


def write_face_values(mesh, name, values):
    """Writes (#F,) numbers as a float attribute of the faces, in place of an attribute of that name."""
    if not is_attribute(mesh, name, "FACE", "FLOAT"):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        mesh.attributes.new(name, "FLOAT", "FACE")
    write_values(Values(mesh.attributes[name].data, "value", np.float32), values)


def is_attribute(mesh, name, domain, kind):
    """Whether there is an attribute of this name, and it is of this domain and type."""
    attribute = mesh.attributes.get(name)
    return attribute is not None and (attribute.domain, attribute.data_type) == (domain, kind)


def read_shown(obj, own):
    """(`Polygons`, (n, 2) vertices of the seams, those of edges marked sharp, whether the faces are those of `own`) of
    an object with its modifiers as the viewport shows them."""
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    try:
        found = read_polygons(mesh, linear(obj))
        return found, *(marked_edges(mesh, mark) for mark in (SEAM, SHARP)), found.has_faces_of(own)
    finally:
        shown.to_mesh_clear()


def marked_edges(mesh, *marks):
    """(n, 2) vertices of the edges with one of these marks after the other: `SEAM`, `SHARP`, "select"."""
    found = [_edge_vertices(mesh)[read_values(_marks(mesh, mark))] for mark in marks]
    return np.concatenate([np.empty((0, 2), np.int64), *found])


def mark_edges(mesh, mark, vertex_pairs):
    """Gives the edges between these (n, 2) vertices the mark, and no other edge."""
    write_values(_marks(mesh, mark), _edges_between(mesh, vertex_pairs))


def read_seams(mesh):
    """(#mesh edges,) bool."""
    return read_values(_marks(mesh, SEAM))


def add_seams(mesh, vertex_pairs):
    """Marks the edges with these (#S,2) vertices as seams, keeps every seam there is; returns how many are new."""
    wanted, before = _edges_between(mesh, vertex_pairs), read_seams(mesh)
    write_values(_marks(mesh, SEAM), before | wanted)
    return int(np.count_nonzero(wanted & ~before))


def are_neighbours(mesh, vertices):
    """Whether some edge joins two of the vertices."""
    return bool(np.isin(_edge_vertices(mesh), vertices).all(axis=1).any())


def edge_vectors(mesh, vertex_pairs):
    """(n, 3) from the first to the second of (n, 2) vertices."""
    positions = read_values(compatibility.position_values(mesh)).astype(np.float64)
    return positions[vertex_pairs[:, 1]] - positions[vertex_pairs[:, 0]]


def _edge_vertices(mesh):
    return read_indices(compatibility.edge_vertex_values(mesh))


def _marks(mesh, mark):
    return Values(mesh.edges, mark, bool)


def _edges_between(mesh, vertex_pairs):
    """(#mesh edges,) bool: the edges whose vertices are one of the pairs."""
    keys, wanted = (
        native.load().mesh.edges.edge_keys(e, len(mesh.vertices)) for e in (_edge_vertices(mesh), vertex_pairs)
    )
    return np.isin(keys, wanted)


def selected_vertices(mesh):
    """(n,) selected vertices: in edit mode in the order in which they were picked, as far as Blender remembers it."""
    selected = np.flatnonzero(read_values(Values(mesh.vertices, "select", bool)))
    if not mesh.is_editmode:
        return selected
    history = bmesh.from_edit_mesh(mesh).select_history[:]  # a list: Python 3.13 finds no iterator of Blender 4.3's
    picked = np.array([e.index for e in history if isinstance(e, bmesh.types.BMVert)], np.int64)
    return np.concatenate([picked[np.isin(picked, selected)], selected[~np.isin(selected, picked)]])


def weights(mesh, group):
    """(#V,) weights in the vertex group of this index; one by one, for Blender has no array of them."""
    of_each = (next((g.weight for g in vertex.groups if g.group == group), 0.0) for vertex in mesh.vertices)
    return np.fromiter(of_each, np.float64, len(mesh.vertices))


def new_mesh(name, vertices, corner_vertices, face_offsets, edges=()):
    """A Blender mesh of these polygons, vertices and corners in their order; `edges` are (n, 2) further ones."""
    mesh = bpy.data.meshes.new(name)
    fill(mesh, vertices, corner_vertices, face_offsets, edges)
    return mesh


def fill(mesh, vertices, corner_vertices, face_offsets, edges=()):
    """Gives a new mesh these elements, as `new_mesh`."""
    mesh.vertices.add(len(vertices))
    write_values(compatibility.position_values(mesh), vertices)
    if len(edges):
        mesh.edges.add(len(edges))
        write_values(compatibility.edge_vertex_values(mesh), edges)
    mesh.loops.add(len(corner_vertices))
    write_values(Values(mesh.loops, "vertex_index", np.uint32), corner_vertices)
    mesh.polygons.add(len(face_offsets) - 1)
    write_values(Values(mesh.polygons, "loop_start", np.uint32), face_offsets[:-1])
    write_values(Values(mesh.polygons, "loop_total", np.uint32), np.diff(face_offsets))  # needed before 4.1
    mesh.update(calc_edges=True)


def shade_smooth(mesh, sharp_angle):
    """Smooth shading, edges sharper than `sharp_angle` (radians) excepted."""
    write_values(Values(mesh.polygons, "use_smooth", bool), np.ones(len(mesh.polygons), bool))
    compatibility.keep_sharp_edges(mesh, sharp_angle)
    mesh.update()


def world_points(obj, vertices=slice(None)):
    """(n,3) float64 positions in the world of vertices of an object's mesh, by default of all."""
    positions = read_values(compatibility.position_values(obj.data))[vertices]
    matrix = np.array(obj.matrix_world, np.float64)
    return positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
