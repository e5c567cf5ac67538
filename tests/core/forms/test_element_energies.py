"""Energies of functions of order p against 200 bits: within their bounds, on metrics that are wrong by what is said."""

import exact_elements
import numpy as np
import pytest
from exact_metrics import hexagonal_torus, largest_part, missed
from flint import arb
from holomorph import _native, conformal_structure
from interval_energies import is_positive, of_doubles
from small_families import SMALL
from solved import surface_of

ORDERS = [1, 2, 3, 6, 10]
ROUNDING = 1e-12  # relative


def level_of(surface, classes, order):
    """A native level, and its forms."""
    count = classes.shape[1] // 3
    return _native.solve_level(surface, classes, count, order, 1, None), count


def steps(faces, n):
    """(#T, 6) the classes on a torus of n x n vertices: the steps along its two directions, at sides."""
    a, b = faces, np.roll(faces, -1, axis=1)
    both = [(b // n - a // n + 1) % n - 1, (b % n - a % n + 1) % n - 1]
    return np.stack(both, axis=2).reshape(len(faces), 6).astype(np.int32)


def measured(surface, classes, order, noise, seed=0):
    """A level, functions near its own, and what the core measures of them."""
    level, count = level_of(surface, classes, order)
    random = np.random.default_rng(seed)
    functions = level.functions + noise * random.standard_normal(level.functions.shape)
    energies = _native.measure_level(surface, classes, count, order, functions)
    return level, functions, energies.gram[0], energies.certain[0]


@pytest.mark.parametrize("noise", [0.0, 1e-3, 1.0])
@pytest.mark.parametrize("order", ORDERS)
def test_bounds_hold_the_exact_energies(order, noise):
    structure = conformal_structure(surface_of(SMALL["torus 2 1 6 4"]))._native
    assert structure.flip_count() == 0  # edges run from the lower vertex to the higher
    level, functions, _, certain = measured(structure.surface(), structure.side_classes(), order, noise)
    oracle = exact_elements.gram(level, order, functions)
    assert is_positive(of_doubles(certain) - oracle)
    assert is_positive(oracle * (1 + arb(ROUNDING)) - of_doubles(certain))


@pytest.mark.parametrize("order", [1, 2, 4])
def test_errors_of_faces_add_up(order):
    """Faces stand for ones on which all energies are larger by what is said of them."""
    random, n = np.random.default_rng(0), 3
    growth = random.uniform(0, 1e-3, 2 * n * n)
    surface, faces = hexagonal_torus(n, growth)
    classes = steps(faces, n)
    level, functions, value, certain = measured(surface, classes, order, 1.0)
    true = exact_elements.gram(level, order, functions, level.errors)
    assert sorted(level.errors) == sorted(growth)
    assert 1 - 1e-2 < largest_part(missed(true, value), certain - value) <= 1
