# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's meshes, images and arrays: the only module that calls foreach_get and foreach_set.

Positions and UVs are double precision on our side and float32 on Blender's. Corners are in the order of
the polygons, which before Blender 4.0 need not be the order of the mesh's loops.
"""

import re
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

from .. import compatibility
from ..compatibility import Values

MAIN_MAP = "Holomorphic"
SHAPE = "Holomorphic Shape"  # vector attribute of vertices
OWN_MAPS = "holomorph_maps"  # custom property of a mesh: names of the maps that were made here, one in a line


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

    def share(self, surface):
        """Takes the arrays of the surface that was made of these, where they are equal: one copy of them is left."""
        if not surface.is_whole:
            return
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


def read_values(values):
    """(n,) or, for a width above 1, (n, width) array of `compatibility.Values`."""
    array = np.empty(len(values.elements) * values.width, values.dtype)
    values.elements.foreach_get(values.name, array)
    return array if values.width == 1 else array.reshape(-1, values.width)


def write_values(values, array):
    """The reverse of `read_values`."""
    values.elements.foreach_set(values.name, np.ascontiguousarray(array, values.dtype).ravel())


def write_pixels(image, pixels):
    """Writes (height, width, 4) float32, the lowest row first, in the image's own colour space."""
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())


def read_indices(values):
    """Vertices, loops or lengths as int32, which they fit: Blender has at most 2^31 of each."""
    return read_values(values).view(np.int32)


def read_polygons(mesh, linear):
    """Copies the polygons out of `mesh`, positions multiplied by the 3x3 matrix `linear`.

    The object's rotation and translation do not change angles, its scale and shear do. The library
    checks the arrays: Blender's own ``validate`` would change the mesh.
    """
    positions = read_values(compatibility.position_values(mesh))
    vertices, linear = positions.astype(np.float64), np.asarray(linear, np.float64)
    if not np.array_equal(linear, np.eye(3)):
        with np.errstate(all="ignore"):  # the library names the vertex of a NaN
            vertices = vertices @ linear.T
    corner_vertices = read_indices(compatibility.corner_vertex_values(mesh))
    starts = read_indices(Values(mesh.polygons, "loop_start", np.uint32))
    sizes = read_indices(Values(mesh.polygons, "loop_total", np.uint32))
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


def own_maps(mesh):
    """Names of the maps that were made here, the main one first."""
    return str(mesh.get(OWN_MAPS, "")).splitlines()


def add_own_maps(mesh, names):
    """Notes which maps were made here: a name alone may be that of someone else's map."""
    mesh[OWN_MAPS] = "\n".join(dict.fromkeys([*own_maps(mesh), *names]))


def _own_map(mesh, name):
    """The map of ours that was to have this name, "" without one; Blender numbers it where the name was taken."""
    numbered = re.compile(rf"{re.escape(name)}(\.[0-9]+)?")
    return next((own for own in own_maps(mesh) if numbered.fullmatch(own) and _has_map(mesh, own)), "")


def main_map(mesh):
    """The name of the main map, "" without one; another than `MAIN_MAP` where that is taken by someone else's map."""
    return _own_map(mesh, MAIN_MAP)


def is_own_attribute(mesh, attribute):
    """Whether a corner attribute is a map of ours; from Blender 3.5 on, UV maps are such attributes too."""
    is_map = attribute.domain == "CORNER" and attribute.data_type == "FLOAT2"
    return is_map and attribute.name in own_maps(mesh)


def has_maps(mesh):
    """Whether there are maps of an earlier run."""
    return any(_has_map(mesh, name) for name in own_maps(mesh))


def remove_maps(mesh):
    """Removes the maps of an earlier run, and no other."""
    own = own_maps(mesh)
    for name in [layer.name for layer in mesh.uv_layers if layer.name in own]:
        mesh.uv_layers.remove(mesh.uv_layers[name])
    for name in [a.name for a in mesh.attributes if is_own_attribute(mesh, a) or a.name == SHAPE]:
        mesh.attributes.remove(mesh.attributes[name])
    if OWN_MAPS in mesh:
        del mesh[OWN_MAPS]


def _of_loops(mesh, polygons, uv, before=""):
    """(#C,2) in the order of the loops; without `polygons` it is. Loops of no corner have what the map `before` has."""
    if polygons is None or polygons.loops is None:
        return uv
    scattered = read_map(mesh, before) if before else np.zeros((len(mesh.loops), 2), np.float32)
    scattered[polygons.loops] = uv
    return scattered


def write_map(mesh, polygons, name, uv):
    """Writes (#C,2) float32 `uv` as a new UV map, or as a corner attribute when all slots are taken.

    Where these are some of the mesh's polygons, the others keep the UVs that they have in our map of this name, or else
    in the active one.
    """
    own = "" if polygons.faces is None else _own_map(mesh, name)
    if own:
        overwrite_map(mesh, polygons, own, uv)
        is_uv_map = own in mesh.uv_layers.keys()[: compatibility.UV_MAP_LIMIT]  # further ones are attributes as well
        return WrittenMap(own, "uv_map" if is_uv_map else "attribute")
    uv = _of_loops(mesh, polygons, uv, "" if polygons.faces is None else getattr(mesh.uv_layers.active, "name", ""))
    # References to layers do not survive the next `new`: look up by name, keep nothing.
    if len(mesh.uv_layers) < compatibility.UV_MAP_LIMIT:
        layer = mesh.uv_layers.new(name=name, do_init=False)
        write_values(compatibility.uv_values(layer), uv)
        return WrittenMap(layer.name, "uv_map")
    attribute = mesh.attributes.new(name, "FLOAT2", "CORNER")
    write_values(_attribute_vectors(attribute, 2), uv)
    return WrittenMap(attribute.name, "attribute")


def _has_map(mesh, name):
    return name in mesh.uv_layers or name in mesh.attributes


def write_shape(mesh, points):
    """Writes (#V,3) points as a vector attribute of the vertices."""
    if SHAPE in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[SHAPE])
    attribute = mesh.attributes.new(SHAPE, "FLOAT_VECTOR", "POINT")
    write_values(_attribute_vectors(attribute, 3), points)


def write_face_values(mesh, name, values):
    """Writes (#F,) numbers as a float attribute of the faces, in place of an attribute of that name."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", "FLOAT"):
        if attribute is not None:
            mesh.attributes.remove(attribute)
        attribute = mesh.attributes.new(name, "FLOAT", "FACE")
    write_values(Values(attribute.data, "value", np.float32), values)


def _attribute_vectors(attribute, width):
    return Values(attribute.data, "vector", np.float32, width)


def read_map(mesh, name):
    """(#loops,2) float32 of a UV map or corner attribute."""
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        return read_values(compatibility.uv_values(layer))
    return read_values(_attribute_vectors(mesh.attributes[name], 2))


def read_corners(mesh, polygons, name):
    """(#C,2) float32 of a map, corners in the order of `polygons`."""
    values = read_map(mesh, name)
    return values if polygons.loops is None else values[polygons.loops]


def overwrite_map(mesh, polygons, name, uv):
    """Writes (#C,2) float32 `uv` into a UV map or corner attribute that there is."""
    layer = mesh.uv_layers.get(name)
    values = _attribute_vectors(mesh.attributes[name], 2) if layer is None else compatibility.uv_values(layer)
    is_part = polygons is not None and polygons.faces is not None
    write_values(values, _of_loops(mesh, polygons, uv, name if is_part else ""))
    mesh.update()


def show_map(mesh, name):
    """Makes a UV map the active one, in the editors and for rendering; an attribute cannot be."""
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        mesh.uv_layers.active = layer
        layer.active_render = True


def selected_vertices(mesh):
    """(n,) selected vertices: in edit mode in the order in which they were picked, as far as Blender remembers it."""
    selected = np.flatnonzero(read_values(Values(mesh.vertices, "select", bool)))
    if not mesh.is_editmode:
        return selected
    history = bmesh.from_edit_mesh(mesh).select_history
    picked = np.array([e.index for e in history if isinstance(e, bmesh.types.BMVert)], np.int64)
    return np.concatenate([picked[np.isin(picked, selected)], selected[~np.isin(selected, picked)]])


def weights(mesh, group):
    """(#V,) weights in the vertex group of this index; one by one, for Blender has no array of them."""
    of_each = (next((g.weight for g in vertex.groups if g.group == group), 0.0) for vertex in mesh.vertices)
    return np.fromiter(of_each, np.float64, len(mesh.vertices))


def corner_normals(mesh):
    """(#loops, 3)"""
    return read_values(compatibility.corner_normal_values(mesh))


def new_mesh(name, vertices, corner_vertices, face_offsets):
    """A Blender mesh of these polygons, vertices and corners in their order."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    write_values(compatibility.position_values(mesh), vertices)
    mesh.loops.add(len(corner_vertices))
    write_values(Values(mesh.loops, "vertex_index", np.uint32), corner_vertices)
    mesh.polygons.add(len(face_offsets) - 1)
    write_values(Values(mesh.polygons, "loop_start", np.uint32), face_offsets[:-1])
    write_values(Values(mesh.polygons, "loop_total", np.uint32), np.diff(face_offsets))  # needed before 4.1
    mesh.update(calc_edges=True)
    return mesh


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
