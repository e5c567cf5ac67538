"""Baking in a real window: in the background of other events, cancelled, undone."""

import pytest


def test_a_bake_shows_its_images(seen):
    images, material, maps, others = seen["baked"]
    assert seen["begin"] == ["RUNNING_MODAL"]
    assert images == ["Ring Colour", "Ring Normal", "Ring Roughness"] and material == "Ring Baked"
    assert maps == ["Holomorphic", "Holomorphic Bake"] and others == seen["before"][3]


@pytest.mark.parametrize("step", ["after ESC", "undone"])
def test_nothing_is_left_of_it(seen, step):
    assert seen[step] == seen["before"]
