"""Seamless tilings in a real window: the redo panel, presets, marks of poles, dragging them."""

import pytest


@pytest.fixture(scope="module")
def seen(take_steps):
    return take_steps("tile_steps")


def test_every_step_was_taken(seen):
    assert "traceback" not in seen, seen["traceback"]
