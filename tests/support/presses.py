"""Operators that make or change objects, each pressed in a scene that has what it needs, in any mode."""

import math
from typing import NamedTuple

import bpy
import numpy as np
from loaded_addon import module
from scenes import select, two_objects

IMAGE = 8  # pixels of a side


class Press(NamedTuple):
    scene: object  # makes what there is before
    call: object  # runs the operator; returns what it returns


def maps(**options):
    return bpy.ops.uv.holomorphic_maps(main="BALANCED", seams=True, shape=True, **options)


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(tiles=20, empties=True, seams=True, **options)


def islands():
    """Along the seams of an earlier map: Blender 5.2 packs many islands in seconds."""
    return bpy.ops.uv.holomorphic_islands(hard_edges=math.pi, texture="SCALES")


def levels(ratio=0.6):
    return bpy.ops.object.holomorphic_levels(levels=2, ratio=ratio)


def stud(**options):
    return bpy.ops.object.holomorphic_geometry(piece="STUD", columns=1, **options)


def own_piece():
    return bpy.ops.object.holomorphic_geometry(piece="OBJECT", source="Ball", columns=1)


def relief():
    return bpy.ops.object.holomorphic_relief(image="Dots", most_triangles=200)


def texels():
    return bpy.ops.uv.holomorphic_texels_set(texels=100.0)


def select_bad():
    return bpy.ops.mesh.holomorphic_select_bad(kinds={"LOOSE"})


def select_stretched():
    return bpy.ops.mesh.holomorphic_select_stretched(size=1.0)


def drag():
    return bpy.ops.uv.holomorphic_drag_poles(moves="0:7")


def bake():
    return bpy.ops.object.holomorphic_bake(texels=8.0, channels={"COLOUR"})


def after(*runs):
    """A scene in which these were run already."""

    def scene():
        two_objects()
        for run in runs:
            assert run() == {"FINISHED"}

    return scene


def mapped_and_tiled():
    """With maps, materials, empties and reports to be replaced, and slots in use."""
    two_objects()
    maps()
    tile(texture="BRICKS")
    bpy.ops.uv.holomorphic_heat()
    bpy.data.objects["Ball"].data.polygons[3].material_index = 2


def with_groups():
    torus, _ = two_objects()
    torus.vertex_groups.new(name="Group").add([0, 1, 2], 0.5, "REPLACE")


def with_modifiers():
    """And objects that were made of what they make."""
    for obj in two_objects():
        obj.modifiers.new("Finer", "SUBSURF").levels = 1
    maps(modifiers=True)
    for name in ("Torus", "Ball"):
        bpy.data.objects[name].hide_set(False)
    select(bpy.data.objects["Torus"], bpy.data.objects["Ball"])


def with_poles():
    torus, _ = two_objects()
    select(torus)
    tile(pole_count=2, poles="COUNT")


def with_a_turning_picture():
    """That does not look the same after the turn."""
    two_objects()
    picture(np.linspace(0, 1, IMAGE))
    bpy.ops.uv.holomorphic_tile(texture="IMAGE", source="Dots", turns="QUARTER")


def with_a_picture():
    two_objects()
    tile(turns="NONE")  # the picture does not look the same after a turn
    picture()


def picture(red=1.0):
    """With a square hole; red : (IMAGE,) in each column"""
    pixels = np.ones((IMAGE, IMAGE, 4), np.float32)
    pixels[..., 0] = red
    pixels[: IMAGE // 2, : IMAGE // 2, :3] = 0
    image = bpy.data.images.new("Dots", IMAGE, IMAGE)
    module("scene.image_io").write_pixels(image, pixels)
    image.pack()
    image.use_fake_user = True  # so that it is in the file


def dirty():
    """Loose vertices, shape keys and maps."""
    for obj in two_objects():
        obj.data.vertices.add(1)
        obj.data.update()
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Key").data[3].co.z += 1
        obj.data.uv_layers.new(name="Own")


PRESSES = {
    "maps": Press(two_objects, maps),
    "automatic": Press(two_objects, lambda: bpy.ops.uv.holomorphic_maps()),
    "maps again": Press(mapped_and_tiled, maps),
    "tile": Press(two_objects, tile),
    "tile again": Press(mapped_and_tiled, tile),
    "islands": Press(after(maps), islands),
    "modifiers": Press(with_modifiers, lambda: maps(modifiers=True)),
    "levels": Press(with_groups, levels),
    "levels again": Press(after(lambda: levels(ratio=0.8)), levels),
    "geometry": Press(after(tile), stud),
    "geometry again": Press(after(tile, lambda: stud(place="CORNERS")), stud),
    "own piece": Press(after(tile), own_piece),
    "lines": Press(after(tile), bpy.ops.object.holomorphic_lines),
    "lines again": Press(
        after(tile, lambda: bpy.ops.object.holomorphic_lines()), lambda: bpy.ops.object.holomorphic_lines(per_tile=1)
    ),
    "cells": Press(after(tile), bpy.ops.object.holomorphic_cells),
    "cells again": Press(
        after(tile, lambda: bpy.ops.object.holomorphic_cells()), lambda: bpy.ops.object.holomorphic_cells(simple=True)
    ),
    "relief": Press(with_a_picture, relief),
    "drag": Press(with_poles, drag),
    "bake": Press(after(lambda: tile(texture="BRICKS")), bake),
    "texels": Press(after(maps), texels),
    "heat": Press(after(maps, tile), bpy.ops.uv.holomorphic_heat),
    "symmetric": Press(with_a_turning_picture, bpy.ops.uv.holomorphic_make_symmetric),
    "restore": Press(mapped_and_tiled, bpy.ops.uv.holomorphic_restore_materials),
    "remove": Press(mapped_and_tiled, bpy.ops.uv.holomorphic_remove_maps),
    "bad": Press(dirty, select_bad),
    "stretched": Press(after(maps), select_stretched),
    "repair": Press(dirty, bpy.ops.mesh.holomorphic_repair),
    "assets": Press(two_objects, bpy.ops.object.holomorphic_assets),
}


def pose():
    """An armature in pose mode beside the active mesh, which is in object mode, as without Lock Object Modes."""
    obj = bpy.context.view_layer.objects.active
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="POSE")
    bpy.context.view_layer.objects.active = obj


def edit():
    """With some faces of all selected objects selected."""
    for obj in bpy.context.selected_objects:
        for polygon in obj.data.polygons:
            polygon.select = polygon.index % 10 < 5
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="FACE")


MODES = {
    "OBJECT": lambda: None,
    "EDIT": edit,
    "SCULPT": lambda: bpy.ops.object.mode_set(mode="SCULPT"),
    "WEIGHT_PAINT": lambda: bpy.ops.object.mode_set(mode="WEIGHT_PAINT"),
    "POSE": pose,
}


def prepared(name, mode):
    """Makes the scene, in this mode, and returns the `Press`."""
    PRESSES[name].scene()
    MODES[mode]()
    return PRESSES[name]
