"""What is drawn over the 3D view of a real window, by the colours of its pixels."""

import numpy as np
import pytest

NEAR = 10 / 255  # difference of a colour on the screen
PICTURES = ["heat_nothing.png", "heat_density.png", "heat_angle.png", "heat_stretched.png", "with_poles.png"]


def near(first, second):
    return np.abs(np.subtract(first, second)).max() < NEAR


@pytest.mark.parametrize("name", ["density", "angle", "stretched"])
def test_faces_have_the_colours_of_the_heat_map(seen, name):
    assert near(seen[name]["top"], seen[name]["expected"])
    assert not near(seen[name]["top"], seen["nothing"]["top"])


def test_the_legend_begins_and_ends_with_the_colours_of_the_scale(seen):
    assert near(seen["density"]["left"], (0.13, 0.27, 0.60)) and near(seen["density"]["right"], (0.66, 0.13, 0.14))
    assert near(seen["angle"]["left"], (0.90, 0.89, 0.86)) and near(seen["angle"]["right"], (0.28, 0.05, 0.33))


def test_the_heat_map_follows_the_map(seen):
    assert not near(seen["stretched"]["top"], seen["angle"]["top"])


@pytest.mark.parametrize("name", ["without overlays", "not selected", "off", "disabled"])
def test_nothing_is_drawn(seen, name):
    for place in ("top", "left", "right"):
        assert near(seen[name][place], seen["nothing"][place])


@pytest.mark.parametrize("name", ["with overlays", "enabled again"])
def test_it_comes_back(seen, name):
    assert not near(seen[name]["left"], seen["nothing"]["left"])


def test_nothing_else_of_the_view_changes(seen):
    corners = [colours["corner"] for colours in seen.values() if "corner" in colours]
    assert len(corners) > 5 and all(near(colour, corners[0]) for colour in corners)


def test_poles_and_branch_points_are_dots(seen):
    assert near(seen["with poles"]["pole"], (1.0, 0.55, 0.10))
    assert near(seen["with poles"]["branch point"], (0.95, 0.95, 0.95))
    assert not any(near(colour, (1.0, 0.55, 0.10)) for colour in seen["without poles"].values())


def test_the_dots_have_a_legend(seen):
    assert near(seen["with poles"]["legend"], (1.0, 0.55, 0.10))


def test_a_pole_behind_something_shines_through(seen):
    behind, surface = np.array(seen["with poles"]["behind"]), np.array(seen["without poles"]["behind"])
    red, _, blue = behind - surface
    assert red > 2 / 255 and blue < -2 / 255 and not near(behind, (1.0, 0.55, 0.10))


@pytest.mark.parametrize("name", PICTURES)
def test_picture_was_taken(seen, folder, name):
    assert (folder / name).stat().st_size > 10_000
