"""An operator writes all or nothing: with an error at any line that it runs meanwhile, the file is as before.

Each test raises errors before every line that no earlier test has had, where it is run first and last, and before some
of the others.
"""

import math

import bpy
import pytest
from conftest import module
from file_state import differences, file_state
from injection import ERRORS, Lines, stops
from scenes import mesh_object, select, sphere_arrays, torus_arrays

SAMPLE = 25  # one in so many of the lines that earlier tests have had
PUT_BACK = "Nothing is changed"
_had = set()


@pytest.fixture(autouse=True)
def kept_solves():
    """Solves are kept when the file is opened again: their times are in the reports."""
    forget = module("operators.mapping")._forget_solves
    bpy.app.handlers.load_pre.remove(forget)
    yield
    bpy.app.handlers.load_pre.append(forget)


def two_objects():
    """A torus and a ball with what an artist has on them: maps, slots of each kind, seams, attributes, properties."""
    for name, arrays in (("Torus", torus_arrays(around=8, across=5)), ("Ball", sphere_arrays(1))):
        mesh = mesh_object(name, *arrays).data
        for layer in ("First", "Second"):
            mesh.uv_layers.new(name=layer)
        mesh.uv_layers.active = mesh.uv_layers["Second"]
        mesh.edges[3].use_seam = True
        mesh.attributes.new("Height", "FLOAT_VECTOR", "POINT")
        mesh["mine"] = {"size": 3.5}
    torus, ball = bpy.data.objects["Torus"], bpy.data.objects["Ball"]
    for name in ("Of Mesh", "Covered"):
        torus.data.materials.append(bpy.data.materials.new(name))
    torus.material_slots[1].link = "OBJECT"
    torus.material_slots[1].material = bpy.data.materials.new("Of Object")
    torus.data.polygons[5].material_index = 1
    copy = torus.copy()  # shares the mesh
    bpy.context.scene.collection.objects.link(copy)
    select(torus, ball)
    return torus, ball


def check(press):
    """Errors while `press` writes, in the scene as it is."""
    path = bpy.app.tempdir + "before.blend"
    bpy.ops.wm.save_as_mainfile(filepath=path)
    for _ in range(3):  # what is kept of a run changes the lines of the next one
        bpy.ops.wm.open_mainfile(filepath=path)
        with Lines() as lines:
            assert press() == {"FINISHED"}
    after = file_state()
    bpy.ops.wm.open_mainfile(filepath=path)
    before = file_state()
    assert differences(before, after)
    for index, stop in enumerate(_chosen(lines.met)):
        error = ERRORS[index % len(ERRORS)]
        with Lines(stop, error) as traced, pytest.raises(RuntimeError) as raised:
            press()
        assert traced.is_raised
        found = file_state()
        if found == after and PUT_BACK not in str(raised.value):  # what is run when all is done
            bpy.ops.wm.open_mainfile(filepath=path)
        else:
            assert not differences(before, found), (stop, error)


def _chosen(met):
    """The stops of this test."""
    found = []
    for index, (file, line, count) in enumerate(stops(met)):
        stop = file, line, count > 0
        if stop not in _had or index % SAMPLE == 0:
            found.append((file, line, count))
        _had.add(stop)
    return found


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
