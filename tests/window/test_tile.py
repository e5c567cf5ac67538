"""Seamless tilings in a real window: the redo panel, presets, marks of poles, dragging them."""

import pytest

PICTURES = ["tiled.png", "tile_redo_panel.png", "tile_presets.png", "tile_preset.png"]
PICTURES += [f"drag_{step}_{key}.png" for step in ("hovered", "followed") for key in ("ESC", "RET")]
PICTURES += ["drag_kept.png", "drag_other_dials.png", "drag_loaded.png"]


def test_the_button_tiles_in_the_background(seen):
    assert "seamless" in seen["tiled"]


def test_a_preset_acts_at_once_and_places_no_poles_again(seen):
    assert seen["texture after the preset"] == "PLANKS"
    assert "rounding" in seen["stages of the preset"]
    assert not {"level for the poles", "forms for the poles", "harmonic forms"} & set(seen["stages of the preset"])


@pytest.mark.parametrize("key", ["ESC", "RET"])
def test_the_texture_follows_the_pole(seen, key):
    assert seen[f"map changed before {key}"]


def test_escape_takes_everything_back(seen):
    assert seen["map as before after ESC"] and seen["poles as before after ESC"]


def test_enter_keeps_the_pole_where_it_was_put(seen):
    assert not seen["map as before after RET"] and seen["pole is where it was put"]
    assert seen["added distortion after dragging"] < 1.2  # one of two poles alone can make up for the other


def test_it_is_one_undo_step(seen):
    assert seen["map as before after undo"] and seen["pole is there after redo"]


def test_it_stays_with_other_dials_and_in_the_file(seen):
    assert seen["pole is there with other dials"] and seen["pole is there in the file"]
    assert seen["dials of the file"] == ["NONE", 30, 0.8]


def test_the_texture_follows_soon(seen):
    assert seen["seconds until the texture follows"] < 15  # a busy machine draws the window in software


@pytest.mark.parametrize("name", PICTURES)
def test_picture_was_taken(seen, folder, name):
    assert (folder / name).stat().st_size > 10_000
