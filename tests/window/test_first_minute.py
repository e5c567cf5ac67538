"""An artist's first minute in a real window: the result of the button is seen, and said in words."""

import pytest

PICTURES = ["first_before.png", "first_after.png", "first_coarse.png", "first_restored.png"]


def test_the_view_shows_the_texture_and_goes_back(seen):
    assert seen["shading after the button"] == ["SOLID", "TEXTURE"]
    assert seen["shading at the end"] == ["SOLID", "MATERIAL"]


def test_coarse_places_are_found(seen):
    (place,) = seen["places"]
    assert place["times"] > 4


@pytest.mark.parametrize("name", PICTURES)
def test_picture_was_taken(seen, folder, name):
    assert (folder / name).stat().st_size > 10_000
