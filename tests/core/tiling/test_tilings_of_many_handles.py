"""Tilings with hundreds of integers: the work is bounded by their number, and progress and cancelling go on in it."""

import families
import numpy as np
import pytest
from holomorph import Cancelled, Surface, Tiler
from tiled_families import EXACT, jumps

HANDLES = 10, 10
STEPS_PER_INTEGER = 500  # of the reductions


def block(across, along):
    """With so many holes in two directions."""
    solid = np.ones((2 * across + 1, 2 * along + 1, 1), bool)
    solid[1::2, 1::2] = False
    return families.voxel_surface(solid)


def surface(mesh):
    return Surface(mesh.vertices, mesh.corners.reshape(-1, 4))


@pytest.fixture(scope="module")
def crowd():
    """(mesh, tiling) of genus 100."""
    mesh = block(*HANDLES)
    return mesh, Tiler(surface(mesh), 2).tile(evenness=0.5)


def test_every_jump_is_whole(crowd):
    mesh, made = crowd
    difference = jumps(mesh, made.uv, made.poles)
    assert len(difference) > 1000
    assert np.abs(difference - np.rint(difference)).max() < EXACT
    assert np.abs(made.periods).max() >= 1


def test_many_integers_are_rounded_by_blocks(crowd):
    _, made = crowd
    rounding = made.rounding
    assert rounding.integers == 4 * np.prod(HANDLES) + 2
    assert rounding.blocks > 1
    assert rounding.steps < STEPS_PER_INTEGER * rounding.integers
    assert 1 <= rounding.excess < 10
    assert made.added_distortion < 1.5


def test_few_integers_are_rounded_as_a_whole():
    rounding = Tiler(surface(block(2, 2)), 2).tile().rounding
    assert (rounding.integers, rounding.blocks) == (18, 1)


def test_the_same_bits_at_any_number_of_threads():
    given = surface(block(6, 7))
    made = [Tiler(given, 0, threads=threads).tile() for threads in (1, 2, 4)]
    assert made[0].rounding.blocks > 1
    assert all(np.array_equal(made[0].uv, other.uv) for other in made[1:])


@pytest.mark.parametrize(("stage", "times"), [("search for poles", 5), ("rounding", 1)])
def test_cancelled_within_a_stage(stage, times):
    """Any time that progress is asked may be the last: how often that is depends on the clock."""
    given = surface(block(6, 7))
    calls = []

    def stop(_, name):
        calls.append(name)
        return calls.count(stage) < times

    with pytest.raises(Cancelled, match=stage):
        Tiler(given, 2, progress=stop).tile(progress=stop)
    assert calls.count(stage) == times
