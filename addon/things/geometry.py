# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made of the tiling of another one: pieces, wires, cells. Those of an earlier run are replaced.

They have their origin at that of the world, where the points lie that their modifiers move to the surface.
"""

import ast
import math

import bpy
import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..results import tags
from ..scene import mesh_io, stored_dials, uv_maps
from . import pieces, placing, tree, wires

PIECES_OF, WIRES_OF, CELLS_OF, RELIEF_OF = (  # custom properties
    f"holomorph_{kind}_of" for kind in ("geometry", "lines", "cells", "relief")
)
SHARP = math.radians(35)  # angle of a piece's faces above which their edge is seen


def source(obj):
    """(polygons, (#C, 2) UVs, name of the lattice, `Map.turns`) of the tiling of an object. @throws ValueError with one
    sentence"""
    polygons = mesh_io.read(obj)
    if not polygons.face_count:
        raise ValueError(f"{obj.name}: it has no faces")
    name = main_map(obj)
    if not name:
        raise ValueError(f"{obj.name}: it has no UV map: press Seamless Tiling first")
    made, uv = stored_dials.made(obj), uv_maps.read_corners(obj.data, polygons, name).astype(np.float64)
    lattice, turns = (ast.literal_eval(made.lattice), made.turns) if made else ("square", 1)
    return polygons, uv, lattice, turns


def main_map(obj):
    """The name of the map that is taken for its tiling, "" without any."""
    return uv_maps.main_map(obj.data) or getattr(obj.data.uv_layers.active, "name", "")


def write_pieces(step, obj, values, piece, cell):
    """Puts a piece at each of the points with these values of `points.joined`. Returns the object of points.

    step : the `transaction.Step` of the object
    piece : a name in `pieces.PIECES`, an object, or a collection
    cell : `pieces.Cell`
    """
    step.remove(earlier(obj, PIECES_OF))
    made = _object(step, obj, f"{obj.name} Geometry", _points_mesh(obj, values))
    dials = {}
    if isinstance(piece, str):
        shipped = pieces.PIECES[piece]
        own = _object(step, obj, f"{obj.name} {piece.title()}", _piece_mesh(shipped.formula(cell)))
        tags.put(own, PIECES_OF, obj)
        _put_away(step.context, own)
        dials = {"Tilt": shipped.tilt, "Rows Lean in Turn": shipped.is_alternating, "Height": shipped.above}
        piece = own
    dials["UV Map of Image"] = main_map(obj)
    kind = "Object" if isinstance(piece, bpy.types.Object) else "Collection"
    _add_nodes(made, obj, placing.group(), dials | {kind: piece})
    tags.put(made, PIECES_OF, obj)
    return made


def write_wires(step, obj, values):
    """Makes a tube along each of the lines of `wires.joined`. Returns their object."""
    step.remove(earlier(obj, WIRES_OF))
    kept = {name: array for name, array in values.items() if name not in ("edges", "side", "count")}
    made = _object(step, obj, f"{obj.name} Lines", _points_mesh(obj, kept, values["edges"]))
    radius = wires.THICKNESS * float(np.median(values["side"]))
    _add_nodes(made, obj, wires.group(), {"Radius": radius, "Material": obj.active_material})
    tags.put(made, WIRES_OF, obj)
    return made


def write_cells(step, obj, cut):
    """Makes an object of the polygons of a `cut.CutMesh`, and returns it."""
    step.remove(earlier(obj, CELLS_OF))
    cut = cut.mirrored() if is_mirrored(obj) else cut
    polygons = mesh_io.Polygons(_in_world(obj, cut.vertices), cut.corner_vertices, cut.face_offsets, None)
    mesh = mesh_io.new_mesh(f"{obj.name} Cells", polygons.vertices, polygons.corner_vertices, polygons.face_offsets)
    uv_maps.write_map(mesh, polygons, uv_maps.MAIN_MAP, cut.uv.astype(np.float32))
    for name, values in cut.faces.items():
        _write_attribute(mesh, name, values, "FACE")
    made = _object(step, obj, mesh.name, mesh)
    if obj.active_material is not None:
        made.data.materials.append(obj.active_material)
    tags.put(made, CELLS_OF, obj)
    return made


def write_relief(step, obj, relief):
    """Makes an object of the triangles of a `holomorph.Relief`, with the materials of the surface, and returns it."""
    step.remove(earlier(obj, RELIEF_OF))
    triangles = mesh_io.Polygons(_in_world(obj, relief.vertices), relief.corner_vertices, relief.face_offsets, None)
    mesh = mesh_io.new_mesh(f"{obj.name} Relief", triangles.vertices, triangles.corner_vertices, triangles.face_offsets)
    uv_maps.write_map(mesh, triangles, uv_maps.MAIN_MAP, relief.uv.astype(np.float32))
    for slot in obj.material_slots:
        mesh.materials.append(slot.material)
    of_faces = mesh_io.read_values(Values(obj.data.polygons, "material_index", np.int32))
    mesh_io.write_values(Values(mesh.polygons, "material_index", np.int32), of_faces[relief.faces])
    made = _object(step, obj, mesh.name, mesh)
    tags.put(made, RELIEF_OF, obj)
    return made


def earlier(obj, kind):
    """What an earlier run made, without pieces that a copy of its points needs."""
    found = tags.find(kind, obj)
    users = bpy.data.user_map(subset=set(found))
    copies = {user for block in found for user in users[block] if isinstance(user, bpy.types.Object)} - set(found)
    return [block for block in found if block.modifiers or not copies & users[block]]


def _object(step, obj, name, mesh):
    """Makes an object in those collections of `obj` that can be changed."""
    made = bpy.data.objects.new(name, mesh)
    mesh.name = made.name
    for collection in [c for c in obj.users_collection if c.library is None] or [step.context.scene.collection]:
        collection.objects.link(made)
    return made


def _put_away(context, made):
    """Hides the original of a piece: what is seen are its instances."""
    context.view_layer.update()
    if made in compatibility.objects_in(context.view_layer):
        made.hide_set(True)
    made.hide_render = True


def _add_nodes(made, obj, group, dials):
    modifier = made.modifiers.new(group.name, "NODES")
    modifier.node_group = group
    compatibility.set_node_inputs(modifier, {"Surface": obj, "Other Side": is_mirrored(obj)} | dials)


def is_mirrored(obj):
    """Whether faces are seen from outside against their direction: Blender then turns normals over."""
    return obj.matrix_world.determinant() < 0


def _in_world(obj, positions):
    return positions + np.array(obj.matrix_world, np.float64)[:3, 3]


def _points_mesh(obj, values, edges=()):
    positions, none = values[tree.POSITION], np.empty(0, np.int32)
    mesh = mesh_io.new_mesh(f"{obj.name} Points", _in_world(obj, positions), none, np.zeros(1, np.int32), edges)
    for name, array in values.items():
        if name != tree.POSITION:
            _write_attribute(mesh, name, array, "POINT")
    return mesh


def _write_attribute(mesh, name, array, domain):
    kinds = {"i": "INT", "b": "BOOLEAN", "f": "FLOAT"}
    kind = "FLOAT_VECTOR" if array.ndim == 2 else kinds[array.dtype.kind]
    mesh.attributes.new(name, kind, domain)
    mesh_io.write_values(Values(mesh.attributes[name].data, *compatibility.ATTRIBUTES[kind]), array)


def _piece_mesh(shape):
    vertices, faces = shape
    offsets = np.cumsum([0, *map(len, faces)], dtype=np.int32)
    mesh = mesh_io.new_mesh("Piece", vertices, np.array([v for face in faces for v in face], np.int32), offsets)
    mesh_io.shade_smooth(mesh, SHARP)
    return mesh
