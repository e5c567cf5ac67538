"""The parts of an object beside each other in the UV square."""

import numpy as np
import pytest
from loaded_addon import module
from scenes import fills_the_square, run, select, torus, torus_arrays, two_parts, uv

packed = module("native").load()._native.pack


def boxes(kind, count):
    random = np.random.default_rng(count)
    if kind == "equal":
        return np.ones((count, 2))
    if kind == "wide":
        return np.column_stack([random.uniform(5, 50, count), random.uniform(0.1, 1, count)])
    if kind == "points":
        return np.zeros((count, 2))
    return random.uniform(0.05, 1, (count, 2))


@pytest.mark.parametrize("margin", [0.0, 0.02, 0.2])
@pytest.mark.parametrize("count", [1, 2, 7, 60, 500])
@pytest.mark.parametrize("kind", ["equal", "wide", "mixed", "points"])
def test_rectangles_lie_in_the_square_and_apart(kind, count, margin):
    sizes = boxes(kind, count)
    corners, side = packed(sizes, margin)
    rounding = 1e-12 * max(side, 1)
    assert corners.min() >= -rounding and (corners + sizes).max() <= side + rounding
    if kind == "points":
        return
    gap = min(margin, 0.3 / np.sqrt(count)) * side  # kMostGap of flat/arrangement.cpp
    x, y = corners.T
    width, height = sizes.T
    beside = np.maximum(x[:, None] - (x + width)[None], x[None] - (x + width)[:, None])
    above = np.maximum(y[:, None] - (y + height)[None], y[None] - (y + height)[:, None])
    distance = np.maximum(beside, above)[~np.eye(count, dtype=bool)]
    assert count == 1 or distance.min() >= 0.95 * gap - rounding


@pytest.mark.parametrize("kind", ["equal", "mixed"])
def test_the_square_is_used(kind):
    sizes = boxes(kind, 60)
    _, side = packed(sizes, 0.0)
    assert np.prod(sizes, axis=1).sum() > 0.7 * side**2


def test_the_layout_is_the_same_twice_and_of_any_size():
    sizes = boxes("mixed", 40)
    corners, side = packed(sizes, 0.02)
    assert np.array_equal(packed(sizes.copy(), 0.02)[0], corners)
    large, large_side = packed(4096 * sizes, 0.02)  # a power of two: the same bits
    assert large_side == 4096 * side and np.array_equal(large, 4096 * corners)


def polygon_area(values):
    """Areas of quads, (n, 4, 2), whichever way they lie."""
    following = np.roll(values, -1, axis=1)
    return 0.5 * np.abs((values[..., 0] * following[..., 1] - following[..., 0] * values[..., 1]).sum(axis=1)).sum()


def test_parts_do_not_overlap_and_have_one_texel_density():
    vertices, faces = torus_arrays(around=48, across=24)
    obj = two_parts("Two", (vertices, faces), (vertices * 0.5, faces))
    run(margin=0.05)
    values = uv(obj)
    assert fills_the_square(values)
    first, second = np.split(values, 2)
    distance = max(np.concatenate([first.min(0) - second.max(0), second.min(0) - first.max(0)]))
    assert 0.045 < distance < 0.055
    areas = [polygon_area(part.reshape(-1, 4, 2)) for part in (first, second)]
    assert areas[0] == pytest.approx(4 * areas[1], rel=1e-4)


def test_turned_parts_still_fit():
    vertices, faces = torus_arrays()
    obj = two_parts("Two", (vertices, faces), (vertices, faces))
    run(rotation=0.7)
    assert fills_the_square(uv(obj))


def test_every_object_has_the_square_for_itself():
    first, second = torus("First"), torus("Second", thickness=0.2)
    select(first, second)
    run(equal=False)
    assert fills_the_square(uv(first)) and fills_the_square(uv(second))
