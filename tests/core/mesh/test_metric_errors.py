"""What rounding makes of lengths and weights: within the bounds, and near enough to them that a tenth is too little."""

import exact_metrics
import families
import numpy as np
import pytest
from exact_metrics import growth, largest_part, missed, torus_of_two
from flint import arb
from holomorph import Surface, _native, conformal_structure
from interval_energies import exact
from solved import surface_of

NEAR = 0.1  # part of each bound that some true error exceeds


def solved(surface, classes):
    return _native.solve_level(surface, classes, 2, 1, 1, None)


def sides(level):
    """(#T, 3) lengths, entry i opposite corner i."""
    return np.roll(level.lengths[level.triangle_edges], -1, axis=1)


def assert_bounds(parts):
    """No true error passes its bound, and one of them comes near it."""
    assert NEAR < np.max(parts) <= 1


def test_lengths_of_positions():
    parts = []
    for seed in range(8):
        surface = surface_of(families.block_with_holes(1, jitter=0.05, seed=seed))
        structure = conformal_structure(surface)
        level = solved(surface._native, structure._native.side_classes())
        assert structure.flip_count == 0 and (level.triangles == surface.triangles).all()
        points = exact(surface.vertices)[surface.triangles]
        along = np.roll(points, -1, axis=1) - np.roll(points, -2, axis=1)
        parts.append(growth(sides(level), (along * along).sum(axis=2)) / level.errors)
    assert_bounds(parts)


def test_lengths_that_are_given():
    """They are those of integer vectors in space: squares are rounded, their sums, and the root."""
    random, parts = np.random.default_rng(0), []
    for _ in range(1000):
        u, v = random.integers(-(2**51), 2**51, (2, 3))
        vectors = np.array([u, v, u + v])
        lengths = np.sqrt(np.square(vectors.astype(float)).sum(axis=1))
        surface = Surface.from_edge_lengths(np.zeros((2, 3), int), np.tile(lengths, (2, 1)), np.tile(range(3), (2, 1)))
        level = solved(surface._native, torus_of_two(lengths)[1])
        if set(level.lengths) == set(lengths):  # none was flipped
            squares = [arb(sum(int(x) ** 2 for x in vector)) for vector in vectors]
            parts.append(growth(lengths[None], np.array([squares]))[0] / level.errors[0])
    assert len(parts) > 100
    assert_bounds(parts)


@pytest.mark.parametrize("height", [1.0, 1e-2, 1e-5])
def test_lengths_of_flipped_edges(height):
    """The diagonal of a parallelogram instead of the other one, from lengths that are exact."""
    random, parts = np.random.default_rng(1), []
    for _ in range(1500):
        a, b = random.uniform(1, 2), height * random.uniform(0.5, 1)
        long = np.sqrt(a * a + b * b * random.uniform(1, 1.5))  # the angle between a and b is more than a right one
        level = solved(*torus_of_two([a, b, long]))
        if set(level.lengths[:2]) != {a, b} or level.lengths[2] == long:
            continue
        a, b, long = exact([a, b, long])
        squares = np.array([[a * a, b * b, 2 * a * a + 2 * b * b - long * long]])
        parts.append(growth(level.lengths[None], squares)[0] / level.errors[0])
    assert len(parts) > 250
    assert_bounds(parts)


def weights_of(lengths):
    """By how much the energies of the two forms are missed, over their bounds, on two triangles of exact lengths."""
    surface, classes = torus_of_two(lengths)
    level = solved(surface, classes)
    if set(level.lengths) != set(lengths):
        return 0.0
    nothing = np.zeros((1, 2))
    true = exact_metrics.gram(np.tile(lengths, (2, 1)), np.zeros((2, 3), int), classes.reshape(2, 3, 2), nothing)
    by_edges, by_faces = (
        largest_part(missed(true, energies.gram[0]), energies.certain[0] - energies.gram[0])
        for energies in (_native.measure(surface, classes, 2, nothing), level.energies)
    )
    assert by_faces <= 1
    return by_edges


def test_weights_of_right_triangles():
    """That of the hypotenuse is what rounding leaves of nothing, in parts of the largest cotangent."""
    random = np.random.default_rng(2)
    sizes = random.uniform(1, 2, 2000)
    parts = [weights_of([h, np.hypot(w, h), w]) for w, h in zip(sizes, sizes / 49)]
    assert_bounds(parts)
