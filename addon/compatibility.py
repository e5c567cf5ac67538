# SPDX-License-Identifier: GPL-3.0-or-later
"""Every difference between the APIs of Blender 3.4 and 5.2 that this add-on meets."""

import bpy

UV_MAP_LIMIT = 8  # Blender's own: the ninth `uv_layers.new` returns None


def uv_values(layer):
    """The collection and the property that hold a UV layer's vectors (3.5 brought the fast one)."""
    if hasattr(layer, "uv"):
        return layer.uv, "vector"
    return layer.data, "uv"


def position_values(mesh):
    """The collection and the property that hold the positions, as an attribute where there is one."""
    attribute = mesh.attributes.get("position")
    if attribute is not None:
        return attribute.data, "vector"
    return mesh.vertices, "co"


def corner_vertex_values(mesh):
    """The collection and the property that hold the vertex of each corner (100 times faster as attribute)."""
    attribute = mesh.attributes.get(".corner_vert")
    if attribute is not None:
        return attribute.data, "value"
    return mesh.loops, "vertex_index"


def corner_vertex_column(mesh):
    """Where old Blenders keep the same in memory: the elements, the integers of each, and which of them it is."""
    return mesh.loops, 2, 0


def polygon_columns(mesh):
    """Likewise the first loop and the number of loops of each polygon."""
    return (mesh.polygons, 3, 0), (mesh.polygons, 3, 1)


def keeps_records():
    """Whether loops and polygons are records of integers one behind the other, which Blender 3.6 gave up."""
    return bpy.app.version < (3, 6, 0)


def edge_vertex_values(mesh):
    """The collection and the property that hold the two vertices of each edge."""
    attribute = mesh.attributes.get(".edge_verts")
    if attribute is not None:
        return attribute.data, "value"
    return mesh.edges, "vertices"


def enable_nodes(material):
    """Gives the material a node tree; from 5.0 it always has one and the switch is deprecated."""
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return material.node_tree


def set_specular(shader, value):
    """Sets the dielectric reflection of a Principled node, renamed in 4.0."""
    for name in ("Specular IOR Level", "Specular"):
        if name in shader.inputs:
            shader.inputs[name].default_value = value
            return


def keep_sharp_edges(mesh, angle):
    """Leaves edges sharper than `angle` (radians) sharp in a smooth-shaded mesh (auto smooth went in 4.1)."""
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = angle
    else:
        mesh.set_sharp_from_angle(angle=angle)


def objects_being_edited(context):
    """The mesh objects in edit mode; those that share a mesh count once."""
    objects = getattr(context, "objects_in_mode_unique_data", None)
    if objects is None:  # background mode has no screen to ask
        objects = {o.data: o for o in context.view_layer.objects if o.mode == "EDIT"}.values()
    return [o for o in objects if o.type == "MESH"]


def selected_objects(context):
    """The selected objects of the view layer, from any editor and in background mode."""
    return list(context.view_layer.objects.selected)


def copy_auto_smooth(source, target):
    """Auto smooth of one mesh for another, where there is such a setting (until 4.0)."""
    if hasattr(source, "use_auto_smooth"):
        target.use_auto_smooth = source.use_auto_smooth
        target.auto_smooth_angle = source.auto_smooth_angle


def is_auto_smooth(modifier):
    """Whether it is the modifier that Blender 4.1 and later put in the place of the mesh's own auto smooth."""
    group = modifier.node_group if modifier.type == "NODES" else None
    return group is not None and group.name.startswith(("Auto Smooth", "Smooth by Angle"))
