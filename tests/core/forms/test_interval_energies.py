"""Certified bounds against interval arithmetic of another library, on ten small meshes."""

import interval_energies
import numpy as np
import pytest
from flint import arb
from holomorph import _native, conformal_structure
from interval_energies import is_positive, of_doubles
from small_families import SMALL
from solved import surface_of

WIDER = 1 + 1e-9  # than the bounds of the same functions without rounding; 1.5 is asked for
ROUNDING = 1e-12  # relative


def measured(mesh, noise):
    """A structure, and functions of forms in its classes, with noise as of an unfinished solution: their certain Gram
    matrix and its oracle."""
    surface = surface_of(mesh)
    structure = conformal_structure(surface)
    assert structure.flip_count == 0
    native, triangles = structure._native, surface._native.triangles
    classes = native.side_classes()
    count = 2 * surface.genus
    functions = _native.solve_level(native.surface(), classes, count, 1, 1, None).functions
    random = np.random.default_rng(0)
    functions = functions + noise * random.standard_normal(functions.shape)
    energies = _native.measure(native.surface(), classes, count, functions)
    sides = classes.reshape(len(triangles), 3, count)
    return (
        structure,
        energies.gram,
        energies.certain,
        interval_energies.gram(surface.vertices, triangles, sides, functions),
    )


@pytest.mark.parametrize("noise", [0.0, 1e-3], ids=["solved", "stopped at 1e-3"])
@pytest.mark.parametrize("name", SMALL)
def test_bounds_hold_those_without_rounding(name, noise):
    structure, value, certain, oracle = measured(SMALL[name], noise)
    assert is_positive(of_doubles(certain[0]) - oracle)
    assert is_positive(oracle * (1 + arb(ROUNDING)) - of_doubles(certain[0]))
    structure._native.narrow(value, certain, structure.certificate.rounding)
    lower, upper = interval_energies.imaginary_bounds(oracle, structure.canonical_basis)
    found_lower, found_upper = map(of_doubles, structure._native.period_bounds())
    assert is_positive(lower - found_lower)
    assert is_positive(found_upper - upper)
    assert is_positive((upper - lower) * arb(WIDER) - (found_upper - found_lower))


def test_the_oracle_knows_the_energy_of_dx():
    """dx on a rectangle with sides 2 and 3: its area."""
    points = np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    nothing = np.zeros((2, 3, 1))
    assert interval_energies.gram(points, triangles, nothing, points[:, :1])[0, 0].contains(6)
