# SPDX-License-Identifier: GPL-3.0-or-later
"""What meshes that are made of another one take from it by Blender's own transfer."""

import bpy


def weights(context, obj, made, vert_mapping):
    """The weights of its vertex groups, for objects that have these groups."""
    if obj.vertex_groups:
        _transfer(context, obj, made, data_type="VGROUP_WEIGHTS", vert_mapping=vert_mapping)


def maps(context, obj, made):
    """Its UV maps, from the nearest faces."""
    if obj.data.uv_layers:
        _transfer(context, obj, made, data_type="UV", loop_mapping="POLYINTERP_NEAREST")


def _transfer(context, obj, made, **options):
    """From a bare object of the same mesh, in one place with all."""
    bare = bpy.data.objects.new("Holomorph Source", obj.data)
    bare.matrix_world = obj.matrix_world
    context.scene.collection.objects.link(bare)
    context.view_layer.update()
    objects = {"selected_objects": [bare, *made], "selected_editable_objects": [bare, *made]}
    try:
        with context.temp_override(object=bare, active_object=bare, **objects):
            bpy.ops.object.data_transfer(
                **options,
                use_create=True,
                use_object_transform=False,
                layers_select_src="ALL",
                layers_select_dst="NAME",
            )
    finally:
        bpy.data.objects.remove(bare)
