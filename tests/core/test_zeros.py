"""Zeros of holomorphic forms and of differentials with poles: their orders add up to the genus."""

import numpy as np
import pytest
from holomorph import Surface, TopologyError, conformal_structure
from solved import CLOSED, solved, surface_of

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


@pytest.mark.parametrize("punctures", [2, 3])
@pytest.mark.parametrize("name", ["genus 2 block", "genus 3 block", "torus of triangles"])
def test_orders_add_up_with_poles(name, punctures):
    surface = surface_of(CLOSED[name])
    vertices = np.linspace(0, len(surface.vertices) - 1, punctures + 2).astype(int)[1:-1]
    structure = conformal_structure(surface, punctures=vertices)
    for c in combinations(structure):
        assert structure.zeros(c).orders.sum() == 2 * surface.genus - 2 + punctures


REAL = ["skull_low_g2.obj", "double-torus.obj", "elephant_g3_50k.obj", "fertility_ngon_g4.obj", "boot_g12.obj"]


@pytest.mark.parametrize("name", REAL)
def test_real_meshes(meshes, name):
    surface = max(Surface.read(meshes / name).components, key=lambda part: len(part.triangles))
    structure = conformal_structure(surface)
    for c in combinations(structure):
        assert structure.zeros(c).orders.sum() == 2 * surface.genus - 2


@pytest.mark.parametrize("name", REAL[:3])
def test_real_meshes_with_poles(meshes, name):
    surface = max(Surface.read(meshes / name).components, key=lambda part: len(part.triangles))
    try:
        structure = conformal_structure(surface, punctures=[10, len(surface.vertices) // 2])
    except TopologyError as error:
        pytest.skip(str(error))
    for c in combinations(structure):
        assert structure.zeros(c).orders.sum() == 2 * surface.genus
