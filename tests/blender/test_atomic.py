"""An operator writes all or nothing: with an error at any line that it runs meanwhile, the file is as before."""

import math

import bpy
import pytest
from file_state import differences, file_state
from injection import PUT_BACK, Lines, check, stops
from loaded_addon import module
from scenes import mesh_object, select, torus_arrays, two_objects

pytestmark = pytest.mark.usefixtures("kept_solves")


def maps(**options):
    return bpy.ops.uv.holomorphic_maps(main="BALANCED", seams=True, shape=True, **options)


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(tiles=20, empties=True, seams=True, **options)


@pytest.mark.parametrize("press", [maps, tile])
def test_first_run(press):
    two_objects()
    check(press)


@pytest.mark.parametrize("press", [maps, tile])
def test_second_run(press):
    """Maps, materials, empties and reports of the first one are replaced."""
    two_objects()
    tile(texture="BRICKS")
    bpy.ops.uv.holomorphic_heat()
    check(press)


def half_selected():
    """Edit mode, with some faces of both objects selected."""
    for obj in two_objects():
        for polygon in obj.data.polygons:
            polygon.select = polygon.index % 10 < 5
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="FACE")


@pytest.mark.parametrize("mode", ["SCULPT", "TEXTURE_PAINT"])
def test_while_painting(mode):
    two_objects()
    bpy.ops.object.mode_set(mode=mode)
    check(tile)


@pytest.mark.parametrize("press", [maps, tile])
def test_selected_faces(press):
    half_selected()
    check(press)


def islands():
    """Along the seams of an earlier map: Blender 5.2 packs many islands in seconds."""
    return bpy.ops.uv.holomorphic_islands(hard_edges=math.pi, texture="SCALES")


def test_islands():
    two_objects()
    maps()
    check(islands)


def levels(ratio=0.6):
    return bpy.ops.object.holomorphic_levels(levels=2, ratio=ratio)


@pytest.mark.parametrize("is_second", [False, True])
def test_levels(is_second):
    """Without a map of ours one is written, too; a second run removes the levels of the first."""
    torus, _ = two_objects()
    torus.vertex_groups.new(name="Group").add([0, 1, 2], 0.5, "REPLACE")
    if is_second:
        levels(ratio=0.8)  # the same ones would be no difference
    check(levels)


@pytest.mark.parametrize("is_second", [False, True])
def test_geometry(is_second):
    """A second run removes what the first one made."""
    two_objects()
    tile()
    if is_second:
        bpy.ops.object.holomorphic_geometry(piece="BRICK", columns=2)
    check(lambda: bpy.ops.object.holomorphic_geometry(piece="STUD", columns=1))


@pytest.mark.parametrize("name", ["lines", "cells"])
def test_lines_and_cells(name):
    two_objects()
    tile()
    press = getattr(bpy.ops.object, f"holomorphic_{name}")
    press()
    changed = {"lines": {"per_tile": 1}, "cells": {"simple": True}}[name]
    check(lambda: press(**changed))


def test_an_object_of_what_modifiers_make():
    for obj in two_objects():
        obj.modifiers.new("Finer", "SUBSURF").levels = 1
    maps(modifiers=True)
    for name in ("Torus", "Ball"):
        bpy.data.objects[name].hide_set(False)
    select(bpy.data.objects["Torus"], bpy.data.objects["Ball"])
    check(lambda: maps(modifiers=True))


def test_carry():
    torus, _ = two_objects()
    maps()
    other = mesh_object("Other", *torus_arrays(around=12, across=6))
    select(other, torus)
    check(lambda: bpy.ops.object.holomorphic_carry(tolerance=100))


def test_drag():
    torus, _ = two_objects()
    select(torus)
    tile(pole_count=2, poles="COUNT")
    check(lambda: bpy.ops.uv.holomorphic_drag_poles(moves="0:7"))


def test_texels():
    two_objects()
    maps()
    check(lambda: bpy.ops.uv.holomorphic_texels_set(texels=100.0))


@pytest.mark.parametrize(
    "name", ["uv.holomorphic_heat", "uv.holomorphic_restore_materials", "uv.holomorphic_remove_maps"]
)
@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_tools(name, mode):
    two_objects()
    maps()
    tile()
    bpy.data.objects["Ball"].data.polygons[3].material_index = 2
    bpy.ops.object.mode_set(mode=mode)
    space, operator = name.split(".")
    check(getattr(getattr(bpy.ops, space), operator))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_select_bad(mode):
    torus, _ = two_objects()
    torus.data.vertices.add(1)
    torus.data.update()
    bpy.ops.object.mode_set(mode=mode)
    check(lambda: bpy.ops.mesh.holomorphic_select_bad(kinds={"LOOSE"}))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_select_stretched(mode):
    two_objects()
    maps()
    bpy.ops.object.mode_set(mode=mode)
    check(lambda: bpy.ops.mesh.holomorphic_select_stretched(size=1.0))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_repair(mode):
    for obj in two_objects():
        obj.data.vertices.add(1)
        obj.data.update()
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Key").data[3].co.z += 1
        obj.data.uv_layers.new(name="Own")
    bpy.ops.object.mode_set(mode=mode)
    check(bpy.ops.mesh.holomorphic_repair)


def test_undo_after_an_error():
    """A run that failed leaves no undo step in which something is half done."""
    two_objects()
    bpy.ops.ed.undo_push(message="before")
    before = undone()
    with Lines() as lines:
        maps()
    bpy.ops.ed.undo_push(message="maps")
    assert differences(before, undone())
    bpy.ops.ed.undo()
    stop = next(stop for stop in stops(lines.met) if stop[0].endswith("material.py"))
    with Lines(stop, MemoryError), pytest.raises(RuntimeError):
        maps()
    bpy.ops.ed.undo_push(message="failed")
    maps()
    bpy.ops.ed.undo_push(message="maps")
    bpy.ops.ed.undo()
    assert not differences(before, undone())


def undone():
    """The data that Blender's undo brings back: screens and what is chosen for tools stay."""
    return {path: value for path, value in file_state().items() if not path.startswith(("screens", "scenes"))}


def test_the_error_says_that_nothing_is_changed():
    two_objects()
    with Lines() as lines:
        maps()
    stop = next(stop for stop in stops(lines.met) if stop[0].endswith("material.py"))
    with Lines(stop, MemoryError), pytest.raises(RuntimeError, match=f"while Torus was written.*{PUT_BACK}"):
        maps()


def bake(folder, monkeypatch):
    """The end of a bake: the work itself changes nothing, and is done once."""
    two_objects()
    tile(texture="BRICKS")
    found = module("baking.bake")
    work = found.BakeWork(
        bpy.context, [bpy.data.objects[name] for name in ("Torus", "Ball")], found.BakeOptions(texels=20.0)
    )
    work.run()
    monkeypatch.setattr(found, "BakeWork", lambda *_arguments: work)
    return lambda: bpy.ops.object.holomorphic_bake(texels=20.0, folder=folder)


def test_bake(monkeypatch):
    check(bake("", monkeypatch))


def test_second_bake(tmp_path, monkeypatch):
    """Images and materials of the first one are replaced."""
    press = bake(str(tmp_path), monkeypatch)
    assert press() == {"FINISHED"}
    check(press)
