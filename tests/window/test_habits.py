"""Habits of Blender in a real window: the pie menu and the keys, selected faces, modifiers."""

import pytest

PICTURES = ["pie_object.png", "pie_edit.png", "faces.png", "tools.png", "skin.png", "skin_mapped.png"]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_the_pie_menu_makes_maps(seen, mode):
    assert seen[f"pie in {mode}"][0] == "Holomorphic" and seen[f"removed in {mode}"] == []


def test_the_key_maps_the_selected_faces(seen):
    assert seen["faces"] == 24 * 24


def test_a_skin_becomes_an_object_with_maps(seen):
    assert "Sheet Mapped" in seen["objects"]


@pytest.mark.parametrize("name", PICTURES)
def test_picture_was_taken(seen, folder, name):
    assert (folder / name).stat().st_size > 10_000
