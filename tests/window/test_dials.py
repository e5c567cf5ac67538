"""Dials of the sidebar in a real window: a map follows a slider, and both are undone together."""

import pytest


@pytest.mark.parametrize("name", ["live", "slow"])
def test_the_map_follows_a_slider_and_undo_takes_both_back(seen, name):
    assert seen[f"{name}: dial and map changed"]
    for step in ("undo", "undone", "redo", "done again"):
        assert seen[f"{name}: {step}"], step


def test_a_quick_map_follows_while_the_slider_is_dragged(seen):
    assert seen["live: followed before the release"]


def test_after_an_unexpected_error_the_map_stays_and_the_next_one_follows(seen):
    assert seen["fault: map stays"] and seen["fault: the next map follows"]


def test_escape_gives_the_dial_back(seen):
    assert seen["escape: waits"] and seen["escape: as before"]
