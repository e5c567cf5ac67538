# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail as objects: copies of the object with the meshes of the levels, in a collection of their own."""

import bpy

from . import compatibility, mesh_io, report, transfer

OF = "holomorph_levels_of"  # custom property of levels and their collection: name of the object they are levels of
GAP = 1.2  # distance of levels side by side, in widths of the object


def write(context, obj, data, work, side_by_side=False):
    """Replaces the levels of an earlier run; `data` is the object's `transfer.MeshData`, `work` a `LevelsWork`."""
    _remove_levels(obj.name)
    collection = _collection(context, obj)
    made = []
    for index, level in enumerate(work.levels, 1):
        made.append(_level_object(obj, data, level, work.names, f"{obj.name}_LOD{index}"))
        collection.objects.link(made[-1])
    context.view_layer.update()
    step = GAP * _width(obj) if side_by_side else 0.0
    for index, level_object in enumerate(made, 1):
        if level_object.name in context.view_layer.objects:
            level_object.select_set(False)  # the next operator is meant for the object alone
        matrix = obj.matrix_world.copy()
        matrix.translation.x += index * step
        level_object.matrix_world = matrix
    _transfer_weights(context, obj, made)
    return made


def _level_object(obj, data, level, names, name):
    """A copy of the object, with its materials, modifiers and parent, but with the mesh of the level."""
    positions = data.positions[level.surface.vertex_index]
    mesh = mesh_io.new_mesh(name, positions, level.surface.corner_vertices, level.surface.face_offsets)
    for material in obj.data.materials:
        mesh.materials.append(material)
    transfer.write(mesh, data, level, names)
    compatibility.copy_auto_smooth(obj.data, mesh)
    copy = obj.copy()
    copy.data = mesh
    copy.name = name
    copy.pop(report.PROPERTY, None)
    copy[OF] = obj.name
    return copy


def _remove_levels(name):
    """Removes the levels of an earlier run."""
    for level in [o for o in bpy.data.objects if o.library is None and o.get(OF) == name and o.name != name]:
        mesh = level.data
        bpy.data.objects.remove(level)
        if mesh is not None and mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def _collection(context, obj):
    """The collection of the levels: a child of a visible, editable collection of the object, else of the scene's."""
    shown = _shown_collections(context.view_layer.layer_collection)
    parent = next((c for c in shown if obj.name in c.objects and c.library is None), context.scene.collection)
    for collection in parent.children:
        if collection.get(OF) == obj.name:
            return collection
    collection = bpy.data.collections.new(f"{obj.name} LODs")
    collection[OF] = obj.name
    parent.children.link(collection)
    return collection


def _shown_collections(layer):
    """The collections of a layer and its children, without those that are excluded from the view layer."""
    if not layer.exclude:
        yield layer.collection
        for child in layer.children:
            yield from _shown_collections(child)


def _width(obj):
    """Size along X in world space."""
    points = mesh_io.world_points(obj)
    return float(points[:, 0].max() - points[:, 0].min())


def _transfer_weights(context, obj, made):
    """Weights by Blender's own transfer, from a bare object of the same mesh: vertices of levels have not moved, and
    the nearest vertex is the same one."""
    if not obj.vertex_groups:
        return
    bare = bpy.data.objects.new("Holomorph Weights", obj.data)
    bare.matrix_world = obj.matrix_world
    context.scene.collection.objects.link(bare)
    context.view_layer.update()
    objects = {"selected_objects": [bare, *made], "selected_editable_objects": [bare, *made]}
    try:
        with context.temp_override(object=bare, active_object=bare, **objects):
            bpy.ops.object.data_transfer(
                data_type="VGROUP_WEIGHTS",
                use_create=True,
                vert_mapping="NEAREST",
                use_object_transform=False,
                layers_select_src="ALL",
                layers_select_dst="NAME",
            )
    finally:
        bpy.data.objects.remove(bare)
