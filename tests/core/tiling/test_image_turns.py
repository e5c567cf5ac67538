"""Which turns leave an image as it is: drawn images, whose groups are known."""

import math

import holomorph
import numpy as np
import pytest
from drawn_images import bricks, checker, cut_noise, hexagons


def moved(pixels, rows, columns):
    return np.roll(pixels, (rows, columns), (0, 1))


def pinwheel(size):
    """What a quarter turn about the middle leaves as it is, and no mirror."""
    arm = np.zeros((size // 2, size // 2))
    arm[: size // 8, : size // 3] = 1
    arm[: size // 3, : size // 16] = 0.4
    return np.block([[arm, np.rot90(arm, 3)], [np.rot90(arm), np.rot90(arm, 2)]])


def arrow(size):
    """What no turn leaves as it is."""
    y, x = np.indices((size, size)) / size
    return ((np.abs(x - 0.5) < 0.4 * y) & (y < 0.6)).astype(float)


IMAGES = {"checker": (checker(64, 2), 4), "pinwheel": (pinwheel(64), 4), "wall": (bricks(64, 64, 2, 1, 0.5), 2)}
IMAGES["upright"] = bricks(96, 64, 1, 1, 0), 2


@pytest.mark.parametrize("shift", [(0, 0), (5, 12), (7, 3)])
@pytest.mark.parametrize("name", IMAGES)
def test_the_turn_and_its_centre(name, shift):
    """Pixels at the places that are turned about the centre are alike."""
    pixels, turns = IMAGES[name]
    pixels = moved(pixels, *shift)
    found = holomorph.image_turns(pixels)
    assert found.turns == turns and found.score == pytest.approx(1)
    assert found.text == f"Looks the same after {'quarter' if turns == 4 else 'half'} turns (100 %)"
    height, width = pixels.shape
    y, x = np.indices(pixels.shape) + 0.5
    u, v = found.centre[0] * width, found.centre[1] * height
    at = (u - (y - v), v + (x - u)) if turns == 4 else (2 * u - x, 2 * v - y)
    columns, rows = (np.floor(place).astype(int) for place in at)
    assert np.allclose(pixels[rows % height, columns % width], pixels)


@pytest.mark.parametrize("height", [222, 221, 443])
def test_hexagons_by_sixths(height):
    found = holomorph.image_turns(moved(hexagons(height, round(height / math.sqrt(3)), 2, 1), 31, 17))
    assert found.turns == 6 and found.score > 0.97


def test_hexagons_in_a_square_by_halves():
    assert holomorph.image_turns(hexagons(128, 128, 8, 7)).turns == 2


@pytest.mark.parametrize("pixels", [arrow(64), cut_noise(128, 128, 1, 3), np.dstack([arrow(64)] * 3)])
def test_what_looks_the_same_after_none(pixels):
    found = holomorph.image_turns(pixels)
    assert found.turns == 1 and found.score < 0.9 and found.centre == (0, 0)
    assert found.text.startswith("Looks the same after no turn (the most like it are ")


def test_colours_count():
    """Three stripes: turned, they come in the other order."""
    stripes = np.broadcast_to(np.eye(3)[np.arange(60) // 20], (60, 60, 3))
    assert holomorph.image_turns(stripes).turns == 1 and holomorph.image_turns(stripes.sum(axis=2)).turns == 4


def test_grain_does_not_count():
    wall = bricks(64, 64, 2, 1, 0.5)
    noise = np.random.default_rng(0).standard_normal(wall.shape) * wall.std()
    assert holomorph.image_turns(wall + 0.1 * noise).turns == 2 and holomorph.image_turns(wall + noise).turns == 1


@pytest.mark.parametrize(
    ("pixels", "turns"), [(np.ones((1, 1)), 4), (np.full((5, 7, 3), 0.2), 2), (np.ones((9, 9)), 4)]
)
def test_one_colour(pixels, turns):
    assert holomorph.image_turns(pixels).turns == turns


@pytest.mark.parametrize("pixels", [np.ones(4), np.ones((2, 2, 5)), np.array([[np.nan]]), np.empty((0, 3))])
def test_what_is_no_image(pixels):
    with pytest.raises(ValueError, match="pixels"):
        holomorph.image_turns(pixels)
