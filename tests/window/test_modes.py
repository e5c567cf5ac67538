"""The button in a real window while an object is sculpted or painted, its undo there, and local view."""

import pytest

BOTH_MAPS = ["Holomorphic", "Holomorphic 1"]
PAINTED = ["Small in TEXTURE_PAINT", "Large in SCULPT"]


@pytest.mark.parametrize("step", PAINTED)
def test_the_mode_stays_with_the_map_and_without_it(seen, step):
    mode = step.split()[-1]
    assert seen[step] == seen[f"{step}, done again"] == [mode, BOTH_MAPS]
    assert seen[f"{step}, undone"] == [mode, []]


def test_redo_makes_another_map_and_undo_takes_it_back_then_the_stroke_of_the_brush(seen):
    if not seen["has a brush"]:
        pytest.skip("this Blender came without its brushes")
    assert seen["after the stroke"] == ["SCULPT", BOTH_MAPS, True, True]
    assert seen["the redo panel"] == ["SCULPT", BOTH_MAPS[:1], True, True]
    assert seen["the map undone"] == ["SCULPT", [], True, True]
    assert seen["the stroke undone"] == ["SCULPT", [], True, True]


def test_only_what_is_in_local_view_is_mapped(seen):
    assert seen["local view"] == [BOTH_MAPS, []]
