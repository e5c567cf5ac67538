"""An artist's first five minutes with seven objects in a real window: each ends with a map that is fit, or with one
sentence and a button that lead there."""

import pytest

FIT = ("cube", "mug", "suzanne", "figure mapped", "terrain", "pipe", "text in islands")
PICTURES = (*FIT, "cube tiled", "figure", "text", "text as mesh")


@pytest.fixture(scope="module")
def seen(take_steps):
    """What either script saw."""
    return take_steps("everyday_steps") | take_steps("special_steps")


@pytest.mark.parametrize("step", FIT)
def test_each_object_gets_a_map_that_is_fit(seen, step):
    assert seen[step]["level"] in ("good", "fair"), seen[step]


def test_what_is_no_mesh_is_left_alone(seen):
    """The bones have no faces, the text no mesh."""
    assert seen["figure"] is None and seen["text"] is None


def test_a_mesh_too_coarse_for_a_tiling_gets_another_map(seen):
    """The cube of eight vertices gets its net."""
    assert seen["cube tiled"]["level"] == "good" and "cube tiled: told" not in seen


@pytest.mark.parametrize("step", PICTURES)
def test_picture_was_taken(seen, folder, step):
    assert (folder / f"five_{step}.png").stat().st_size > 10_000
