"""An operator writes all or nothing: with an error at any line that it runs meanwhile, the file is as before."""

import random

import bpy
import pytest
from file_state import differences, file_state
from injection import PUT_BACK, Lines, Trial, any_of, check, is_refused, stops
from loaded_addon import module
from presses import MODES, PRESSES, maps, prepared, tile
from scenes import two_objects

# The same lines run in every Blender: in newer ones they are tried on demand, and all of them by the suite injection.
ON_DEMAND = [pytest.mark.long] if bpy.app.version >= (4, 0) else []
pytestmark = [pytest.mark.usefixtures("kept_solves"), *ON_DEMAND]
SEED, AT_RANDOM = 45, 6  # operators in each mode, and lines of each
EDITED = "maps", "tile", "heat", "restore", "remove", "bad", "stretched", "repair"


@pytest.mark.parametrize("name", PRESSES)
def test_object_mode(name):
    check(prepared(name, "OBJECT").call)


@pytest.mark.parametrize("name", EDITED)
def test_edit_mode(name):
    check(prepared(name, "EDIT").call)


@pytest.mark.parametrize("mode", ["SCULPT", "TEXTURE_PAINT"])
def test_while_painting(mode):
    two_objects()
    bpy.ops.object.mode_set(mode=mode)
    check(tile)


@pytest.mark.parametrize("mode", MODES)
def test_lines_at_random(mode):
    """Also of those that run before anything is written. The suite injection tries all of them."""
    chance, count = random.Random(f"{SEED} {mode}"), 0
    for name in chance.sample(sorted(PRESSES), len(PRESSES)):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        trial = Trial(prepared(name, mode).call, any_of)
        if not is_refused(trial.result):
            for stop in chance.sample(stops(trial.met), AT_RANDOM):
                assert trial.left_by(stop, KeyboardInterrupt)[0] == [], (name, stop)
            count += 1
        if count == AT_RANDOM:
            break
    assert count == AT_RANDOM


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
