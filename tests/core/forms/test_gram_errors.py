"""The rounding of Gram matrices: within its bounds, and near enough to them that a tenth is too little."""

import exact_metrics
import numpy as np
import pytest
from exact_metrics import UNIT, hexagonal_torus, largest_part, missed
from holomorph import _native

NEAR = 0.1  # part of each bound that some true error exceeds
WEIGHT = 3**-0.5  # of each edge of equilateral triangles


def measured(surface, lengths, faces, classes, functions, growth=None):
    """By how much the energies of forms are missed, over their bounds; faces stand for ones of more energy."""
    count = functions.shape[1]
    energies = _native.measure(surface, classes.reshape(len(faces), -1), count, functions)
    (computed,), (certain,) = energies.gram, energies.certain
    true = exact_metrics.gram(lengths, faces, classes.reshape(len(faces), 3, count), functions, growth)
    return largest_part(missed(true, computed), certain - computed)


@pytest.mark.parametrize("forms", [1, 2])
def test_long_sums(forms):
    """One vertex has nearly all the energy, and its edges come first. Each of the others then adds a little less than
    half of a last bit, which is lost."""
    n = 10
    surface, faces = hexagonal_torus(n)
    colours = (-1.0) ** (np.arange(n * n) // n) * np.sqrt(UNIT / WEIGHT) / 2
    others = np.random.default_rng(0).standard_normal((n * n, forms))
    nothing = np.zeros((len(faces), 3 * forms), np.int32)
    parts = []
    for size in np.linspace(0.9, 1.99, 12):
        functions = others.copy()
        functions[:, 0] = size * colours
        functions[0, 0] = np.sqrt(1.001 * 4 / (6 * WEIGHT))  # the energy is just above a power of two
        parts.append(measured(surface, np.ones(faces.shape), faces, nothing, functions))
    assert NEAR < max(parts) <= 1


def test_values_beside_a_cut():
    """Two rows of right triangles, a long one and a short one, across which the function falls by a little more than
    the 1 of the class: nearly all the energy is there, of what the difference leaves."""
    surface, faces, lengths, classes = two_rows(1e3, 1e-3)
    random, parts = np.random.default_rng(0), []
    for _ in range(500):
        high = random.uniform(0.5, 1.0)
        function = np.repeat([high - 1 - random.uniform(0.005, 0.02), high], 4)
        parts.append(measured(surface, lengths, faces, classes, function[:, None]))
    assert NEAR < max(parts) <= 1


def two_rows(*heights, n=4):
    """A flat torus of two rows of n quads, 1 wide: native surface, faces, lengths opposite their corners, and the class
    on sides that is 1 from the second row of vertices to the first."""
    i, row = np.arange(2 * n) % n, np.arange(2 * n) // n
    a, b = row * n + i, row * n + (i + 1) % n
    c, d = (1 - row) * n + (i + 1) % n, (1 - row) * n + i
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]).astype(np.int64)
    level, upright, across = np.arange(6 * n).reshape(3, 2 * n)
    names = np.concatenate(
        [
            np.stack([row * n + (i + 1) % n + 2 * n, across, level], axis=1),
            np.stack([(1 - row) * n + i, upright, across], axis=1),
        ]
    )
    height = np.asarray(heights)[row]
    one, diagonal = np.ones(2 * n), np.hypot(1, height)
    lengths = np.concatenate([np.stack([height, diagonal, one], axis=1), np.stack([one, height, diagonal], axis=1)])
    surface = _native.refined_surface(2 * n, faces, lengths, names.astype(np.int64), np.zeros(4 * n))
    rises = np.roll(faces, -1, axis=1) // n - faces // n
    is_second = np.tile(row == 1, 2)[:, None]
    return surface, faces, lengths, (-rises * is_second).astype(np.int32)


def test_errors_of_faces_add_up():
    """Faces stand for ones on which all energies are larger by what is said of them."""
    random, n = np.random.default_rng(0), 6
    growth = random.uniform(0, 1e-3, 2 * n * n)
    surface, faces = hexagonal_torus(n, growth)
    functions = random.standard_normal((n * n, 2))
    part = measured(surface, np.ones(faces.shape), faces, np.zeros((len(faces), 6), np.int32), functions, growth)
    assert 1 - 1e-2 < part <= 1
