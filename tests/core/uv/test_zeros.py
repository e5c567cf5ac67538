"""Zeros of holomorphic forms and of differentials with poles: their orders add up to the genus."""

import numpy as np
import pytest
import zero_sums
from holomorph import log_map
from solved import BOUNDED, CLOSED, solved, solved_bounded, surface_of

COMBINATIONS = 10
SURFACES = [name for name, mesh in CLOSED.items() if mesh.genus >= 2]


def combinations(structure, count=COMBINATIONS, seed=0):
    random = np.random.default_rng(seed)
    n = len(structure.balanced_coefficients())
    return random.normal(size=(count, n)) + 1j * random.normal(size=(count, n))


@pytest.mark.parametrize("name", SURFACES)
def test_orders_add_up(name):
    structure = solved(name)
    for c in combinations(structure):
        zeros = structure.zeros(c)
        assert zeros.orders.sum() == 2 * structure.surface.genus - 2
        assert (zeros.positions == structure.surface.vertices[zeros.vertices]).all()


@pytest.mark.parametrize("pole_count", [2, 3])
@pytest.mark.parametrize("name", ["genus 2 block", "genus 3 block", "torus of triangles"])
def test_orders_add_up_with_poles(name, pole_count):
    surface = surface_of(CLOSED[name])
    vertices = np.linspace(0, len(surface.vertices) - 1, pole_count + 2).astype(int)[1:-1]
    structure = log_map(surface, vertices)
    for c in combinations(structure):
        assert structure.zeros(c).orders.sum() == 2 * surface.genus - 2 + pole_count


REAL = [
    "skull_low_g2.obj",
    "double-torus.obj",
    "elephant_g3_50k.obj",
    "fertility_ngon_g4.obj",
    "lionstatue_g3_b1.obj",
    "plate_holes_g5.stl",
    "rna_4P70_YB.off",
    "rna_3JAJ_7.off",
    "tray_g23.stl",
]


@pytest.mark.parametrize("name", REAL)
def test_real_meshes(meshes, name):
    """Without and with poles, with boundaries, and where forms decay to rounding on long arms. The command
    benchmarks/zeros.py does this with all real meshes."""
    found = list(zero_sums.rows(meshes / name))
    assert found
    for _, _, _, right, sums in found:
        assert sums == [right] * zero_sums.COMBINATIONS


@pytest.mark.parametrize("name", [name for name in BOUNDED if "genus" in name or "torus" in name])
def test_orders_add_up_on_the_double(name):
    structure = solved_bounded(name)
    surface = structure.surface
    right = 2 * (2 * surface.genus + surface.boundary_count - 1) - 2
    assert zero_sums.sums(structure) == [right] * zero_sums.COMBINATIONS
