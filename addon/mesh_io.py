# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's meshes and arrays: the only room that calls foreach_get and foreach_set.

Positions and UVs are double precision on our side and float32 on Blender's. Corners are in the order of
the polygons, which before Blender 4.0 need not be the order of the mesh's loops.
"""

import ctypes
import re
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

from . import compatibility

MAIN_MAP = "Holomorphic"
SHAPE = "Holomorphic Shape"  # vector attribute of vertices
OUR_MAP = re.compile(rf"^{MAIN_MAP}( [1-9][0-9]*)?$")


@dataclass(eq=False)
class Polygons:
    """A mesh's polygons as arrays; `loops` gives the loop of each corner, or None where they agree."""

    vertices: np.ndarray  # (#V,3) float64, in the object's frame without its translation
    corner_vertices: np.ndarray  # (#C,) int32
    face_offsets: np.ndarray  # (#F+1,) int32
    loops: np.ndarray | None

    def share(self, surface):
        """Takes the arrays of the surface that was made of these, which are equal: one copy of them is left."""
        self.vertices, self.corner_vertices = surface.vertices, surface.corner_vertices
        self.face_offsets = surface.face_offsets

    def equals(self, other):
        """Whether geometry and topology are the same, whatever the order of the loops; never with a NaN."""
        pairs = (
            (self.face_offsets, other.face_offsets),
            (self.corner_vertices, other.corner_vertices),
            (self.vertices, other.vertices),
        )
        return all(np.array_equal(a, b) for a, b in pairs)


def _get(values, width, dtype):
    collection, name = values
    array = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, array)
    return array


def _integers(values, column):
    """(n,) int32. From records, `foreach_get` takes ten times as long as a copy of their column: that is made where the
    addresses of the elements say that they are records, and the values at both ends agree."""
    elements, width, place = column
    count = len(elements)
    if compatibility.keeps_records() and count > 1:
        ends = (0, 1, count - 1)
        first, second, last = (elements[i].as_pointer() for i in ends)
        size = width * ctypes.sizeof(ctypes.c_int32)
        if (second - first, last - first) == (size, (count - 1) * size):
            records = np.ctypeslib.as_array((ctypes.c_int32 * (width * count)).from_address(first))
            array = records[place::width].copy()
            if all(array[i] == getattr(elements[i], values[1]) for i in ends):
                return array
    return _get(values, 1, np.int32)


def read_values(values, width, dtype):
    """(n,) or, for a width above 1, (n, width) values; `values` is a collection and the name of a property."""
    array = _get(values, width, dtype)
    return array if width == 1 else array.reshape(-1, width)


def write_values(values, array):
    """The reverse of `read_values`; `array` has the type of the property, or it is slow."""
    collection, name = values
    collection.foreach_set(name, np.ascontiguousarray(array).ravel())


def read_polygons(mesh, linear):
    """Copies the polygons out of `mesh`, positions multiplied by the 3x3 matrix `linear`.

    The object's rotation and translation do not change angles, its scale and shear do. Nothing is checked
    here: Blender's own ``validate`` would repair the artist's mesh, so the library judges the arrays.
    """
    positions = _get(compatibility.position_values(mesh), 3, np.float32).reshape(-1, 3)
    vertices, linear = positions.astype(np.float64), np.asarray(linear, np.float64)
    if not np.array_equal(linear, np.eye(3)):
        with np.errstate(all="ignore"):  # a NaN is the library's to name
            vertices = vertices @ linear.T
    corner_vertices = _integers(compatibility.corner_vertex_values(mesh), compatibility.corner_vertex_column(mesh))
    start_column, size_column = compatibility.polygon_columns(mesh)
    starts = _integers((mesh.polygons, "loop_start"), start_column)
    sizes = _integers((mesh.polygons, "loop_total"), size_column)
    offsets = np.zeros(len(starts) + 1, np.int32)
    np.cumsum(sizes, out=offsets[1:])
    loops = None
    if not np.array_equal(starts, offsets[:-1]) or offsets[-1] != len(corner_vertices):
        loops = np.repeat(starts - offsets[:-1], sizes) + np.arange(offsets[-1], dtype=np.int32)
        corner_vertices = corner_vertices[loops]
    return Polygons(vertices, corner_vertices, offsets, loops)


@dataclass(frozen=True)
class WrittenMap:
    """A map as it stands on the mesh: `kind` is "uv_map", or "attribute" where no UV slot was free."""

    name: str
    kind: str


def is_our_attribute(attribute):
    """Whether a corner attribute is a map of ours; from Blender 3.5 on, UV maps are such attributes too."""
    return attribute.domain == "CORNER" and attribute.data_type == "FLOAT2" and bool(OUR_MAP.match(attribute.name))


def remove_maps(mesh):
    """Removes the maps of an earlier run, and no other."""
    for name in [layer.name for layer in mesh.uv_layers if OUR_MAP.match(layer.name)]:
        mesh.uv_layers.remove(mesh.uv_layers[name])
    for name in [a.name for a in mesh.attributes if is_our_attribute(a) or a.name == SHAPE]:
        mesh.attributes.remove(mesh.attributes[name])


def write_map(mesh, polygons, name, uv):
    """Writes (#C,2) float32 `uv` as a new UV map, or as a corner attribute when all slots are taken."""
    values = np.ascontiguousarray(uv, np.float32)
    if polygons.loops is not None:
        scattered = np.zeros((len(mesh.loops), 2), np.float32)
        scattered[polygons.loops] = values
        values = scattered
    # References to layers do not survive the next `new`: look up by name, keep nothing.
    if len(mesh.uv_layers) < compatibility.UV_MAP_LIMIT:
        layer = mesh.uv_layers.new(name=name, do_init=False)
        collection, prop = compatibility.uv_values(layer)
        collection.foreach_set(prop, values.ravel())
        return WrittenMap(layer.name, "uv_map")
    attribute = mesh.attributes.new(name, "FLOAT2", "CORNER")
    attribute.data.foreach_set("vector", values.ravel())
    return WrittenMap(attribute.name, "attribute")


def write_shape(mesh, points):
    """Writes (#V,3) points as a vector attribute of the vertices."""
    attribute = mesh.attributes.new(SHAPE, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", np.ascontiguousarray(points, np.float32).ravel())


def read_map(mesh, name):
    """(#loops,2) float32 of a UV map or corner attribute."""
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        return _get(compatibility.uv_values(layer), 2, np.float32).reshape(-1, 2)
    return _get((mesh.attributes[name].data, "vector"), 2, np.float32).reshape(-1, 2)


def show_map(mesh, name):
    """Makes a UV map the active one, in the editors and for rendering; an attribute cannot be."""
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        mesh.uv_layers.active = layer
        layer.active_render = True


def read_seams(mesh):
    """(#mesh edges,) bool."""
    return _get((mesh.edges, "use_seam"), 1, bool)


def _edge_vertices(mesh):
    return _get(compatibility.edge_vertex_values(mesh), 2, np.int32).reshape(-1, 2)


def seam_vertices(mesh):
    """(#S,2) vertices of the edges that are marked as seams."""
    return marked_edges(mesh, "use_seam")


def selected_vertices(mesh):
    """(n,) selected vertices: in edit mode in the order in which they were picked, as far as Blender remembers it."""
    selected = np.flatnonzero(_get((mesh.vertices, "select"), 1, bool))
    if not mesh.is_editmode:
        return selected
    history = bmesh.from_edit_mesh(mesh).select_history
    picked = np.array([e.index for e in history if isinstance(e, bmesh.types.BMVert)], np.int64)
    return np.concatenate([picked[np.isin(picked, selected)], selected[~np.isin(selected, picked)]])


def are_neighbours(mesh, vertices):
    """Whether some edge joins two of the vertices."""
    return bool(np.isin(_edge_vertices(mesh), vertices).all(axis=1).any())


def marked_edges(mesh, mark):
    """(n, 2) vertices of the edges with this mark, "use_seam" or "use_edge_sharp"."""
    return _edge_vertices(mesh)[_get((mesh.edges, mark), 1, bool)].astype(np.int64)


def mark_edges(mesh, mark, vertex_pairs):
    """Gives the edges between these (n, 2) vertices the mark, and no other edge."""
    mesh.edges.foreach_set(mark, _edges_between(mesh, vertex_pairs))


def _edges_between(mesh, vertex_pairs):
    """(#mesh edges,) bool: the edges whose vertices are one of the pairs."""
    ends = np.sort(_edge_vertices(mesh), axis=1)
    pairs = np.sort(np.asarray(vertex_pairs, np.int64).reshape(-1, 2), axis=1)
    count = len(mesh.vertices)
    return np.isin(ends[:, 0].astype(np.int64) * count + ends[:, 1], pairs[:, 0] * count + pairs[:, 1])


def add_seams(mesh, vertex_pairs):
    """Marks the edges with these (#S,2) vertices as seams, keeps every seam there is; returns how many are new."""
    wanted = _edges_between(mesh, vertex_pairs)
    before = read_seams(mesh)
    mesh.edges.foreach_set("use_seam", before | wanted)
    return int(np.count_nonzero(wanted & ~before))


def new_mesh(name, vertices, corner_vertices, face_offsets):
    """A Blender mesh of these polygons, vertices and corners in their order."""
    mesh = bpy.data.meshes.new(name)
    corners = np.ascontiguousarray(corner_vertices, np.int32)
    offsets = np.ascontiguousarray(face_offsets, np.int32)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(vertices, np.float32).ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(len(offsets) - 1)
    mesh.polygons.foreach_set("loop_start", offsets[:-1].copy())
    mesh.polygons.foreach_set("loop_total", np.diff(offsets))  # needed before 4.1, accepted after
    mesh.update(calc_edges=True)
    return mesh


def shade_smooth(mesh, sharp_angle):
    """Smooth shading, edges sharper than `sharp_angle` (radians) excepted."""
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    compatibility.keep_sharp_edges(mesh, sharp_angle)
    mesh.update()


def world_points(obj):
    """(#V,3) float64 positions of an object's mesh in the world."""
    positions = _get(compatibility.position_values(obj.data), 3, np.float32).reshape(-1, 3)
    matrix = np.array(obj.matrix_world, np.float64)
    return positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
