# SPDX-License-Identifier: GPL-3.0-or-later
"""Every difference between the APIs of Blender 3.4 and 5.2 that this add-on meets."""

from contextlib import contextmanager
from itertools import chain, count
from typing import NamedTuple

import bpy
import numpy as np

from .native import holomorph

UV_MAP_LIMIT = 8  # Blender's own: the ninth `uv_layers.new` returns None

# Attributes by their types: the name, type and number of an element's values.
ATTRIBUTES = {
    "FLOAT": ("value", np.float32),
    "INT": ("value", np.int32),
    "INT8": ("value", np.int32),
    "BOOLEAN": ("value", bool),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
}


class Values(NamedTuple):
    """A property of all elements of a collection, `width` numbers for each.

    `dtype` is Blender's own type of them: any other one is converted element by element, which takes ten times as long.
    Indices are unsigned as properties and signed as attributes.
    """

    elements: object
    name: str
    dtype: type
    width: int = 1


def uv_values(layer):
    """A UV layer's vectors, from 3.5 on those of its attribute. `layer.uv` of 4.0 to 5.0 writes into the copies of the
    mesh, too."""
    if bpy.app.version >= (3, 5, 0):
        return Values(layer.id_data.attributes[layer.name].data, "vector", np.float32, 2)
    return Values(layer.data, "uv", np.float32, 2)


def free_name(mesh, name):
    """The name for a new UV map: before 3.5 Blender gives it that of an attribute, too."""
    if bpy.app.version >= (3, 5, 0):
        return name
    numbered = (f"{name}.{number:03}" for number in count(1))
    return next(free for free in chain([name], numbered) if free not in mesh.attributes)


def position_values(mesh):
    """The positions, as an attribute where there is one."""
    attribute = mesh.attributes.get("position")
    if attribute is not None:
        return Values(attribute.data, "vector", np.float32, 3)
    return Values(mesh.vertices, "co", np.float32, 3)


def polygon_values(mesh):
    """The positions, and the vertex of each corner (100 times faster as attribute)."""
    attribute = mesh.attributes.get(".corner_vert")
    if attribute is not None:
        return position_values(mesh), Values(attribute.data, "value", np.int32)
    return position_values(mesh), Values(mesh.loops, "vertex_index", np.uint32)


def edge_vertex_values(mesh):
    """The two vertices of each edge."""
    attribute = mesh.attributes.get(".edge_verts")
    if attribute is not None:
        return Values(attribute.data, "value", np.int32, 2)
    return Values(mesh.edges, "vertices", np.uint32, 2)


def make_edges_selectable(mesh):
    """Removes a selection of edges that is none: Mesh.from_pydata of 5.0 makes it of pairs of integers, and Blender
    ends when one of them is written."""
    selection = mesh.attributes.get(".select_edge")
    if selection is not None and selection.data_type != "BOOLEAN":
        mesh.attributes.remove(selection)


def enable_nodes(material):
    """Gives the material a node tree; from 5.0 it always has one and the switch is deprecated."""
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return material.node_tree


def has_nodes(material):
    """Whether the material is made of nodes; from 5.0 all are."""
    return material.node_tree is not None and (bpy.app.version >= (5, 0, 0) or material.use_nodes)


def set_specular(shader, value):
    """Sets the dielectric reflection of a Principled node, renamed in 4.0."""
    for name in ("Specular IOR Level", "Specular"):
        if name in shader.inputs:
            shader.inputs[name].default_value = value
            return


def keep_sharp_edges(mesh, angle):
    """Keeps edges sharper than `angle` (radians) sharp in a smooth-shaded mesh (auto smooth was removed in 4.1)."""
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = angle
    else:
        mesh.set_sharp_from_angle(angle=angle)


def objects_in(layer):
    """The objects of a view layer, as a list.

    From 3.4 on Blender brings a view layer up to date late: where it is asked for the active object, but not where it
    is asked for its objects. Until then they are those of before, with ones that are gone, at which a loop ends
    Blender as soon as something in it brings the layer up to date.
    """
    _ = layer.objects.active
    return list(layer.objects)


def selected_in(layer):
    """Those that are selected, as a list."""
    _ = layer.objects.active
    return list(layer.objects.selected)


def objects_being_edited(context):
    """The mesh objects in edit mode; those that share a mesh count once."""
    objects = getattr(context, "objects_in_mode_unique_data", None)
    if objects is None:  # there is no screen in background mode
        objects = {o.data: o for o in objects_in(context.view_layer) if o.mode == "EDIT"}.values()
    return [o for o in objects if o.type == "MESH"]


def shows_tab(region, name):
    """Whether a sidebar shows this tab, as far as Blender tells."""
    return region.type == "UI" and getattr(region, "active_panel_category", "") == name


def copy_auto_smooth(source, target):
    """Auto smooth of one mesh for another, where there is such a setting (until 4.0)."""
    if hasattr(source, "use_auto_smooth"):
        target.use_auto_smooth = source.use_auto_smooth
        target.auto_smooth_angle = source.auto_smooth_angle


def is_auto_smooth(modifier):
    """Whether it is the modifier that replaces a mesh's auto smooth from Blender 4.1 on."""
    group = modifier.node_group if modifier.type == "NODES" else None
    return group is not None and group.name.startswith(("Auto Smooth", "Smooth by Angle"))


@contextmanager
def old_numpy_names():
    """Names that NumPy 1.24 no longer has and the glTF importer of Blender 3.4 uses: Debian ships the two together."""
    if "bool" in vars(np) or bpy.app.version >= (3, 5, 0):
        yield
        return
    np.bool = bool
    try:
        yield
    finally:
        del np.bool


def operator(names):
    """The first of these operators, such as import_scene.fbx, that this Blender has, or the last."""
    operators = [getattr(getattr(bpy.ops, room), name) for room, name in (each.split(".") for each in names)]
    return next(filter(is_there, operators), operators[-1])


def is_there(operator):
    """Whether Blender has an operator: some are options of its build, or add-ons."""
    try:
        operator.get_rna_type()
    except KeyError:
        return False
    return True


OPENERS = {  # of these operators, beside those of the package's `IMPORTERS`, a version of Blender has one or more
    ".blend": ("wm.open_mainfile",),
    ".obj": ("wm.obj_import",),
    ".ply": ("wm.ply_import", "import_mesh.ply"),
    ".stl": ("wm.stl_import", "import_mesh.stl"),
}


def openers():
    """By the suffix of a file, the operator that opens it, where Blender has one."""
    known = holomorph.files.formats.IMPORTERS | OPENERS
    found = {suffix: operator(names) for suffix, names in known.items()}
    return {suffix: one for suffix, one in found.items() if is_there(one)}


def add_socket(tree, name, kind, is_output=False):
    """A new input, or output, of a node tree; the unit of a number is a subtype of its own from 4.0 on."""
    if not hasattr(tree, "interface"):
        return (tree.outputs if is_output else tree.inputs).new(kind, name)
    plain = kind.removesuffix("Angle")
    socket = tree.interface.new_socket(name, in_out="OUTPUT" if is_output else "INPUT", socket_type=plain)
    if plain != kind:
        socket.subtype = "ANGLE"
    return socket


def set_node_inputs(modifier, values):
    """Sets inputs of a modifier's node tree, by their names; they are properties of their own from 5.2 on."""
    tree = modifier.node_group
    if hasattr(tree, "interface"):
        sockets = [item for item in tree.interface.items_tree if item.item_type == "SOCKET" and item.in_out == "INPUT"]
    else:
        sockets = tree.inputs
    identifiers = {socket.name: socket.identifier for socket in sockets}
    for name, value in values.items():
        if hasattr(modifier, "properties"):
            getattr(modifier.properties.inputs, identifiers[name]).value = value
        else:
            modifier[identifiers[name]] = value
