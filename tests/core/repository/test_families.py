"""The mesh families are what they claim to be, by counting without the library."""

import counting
import numpy as np
import pytest
from small_families import FLAT, MESHES


@pytest.mark.parametrize("name", MESHES)
def test_topology(name):
    assert counting.topology(MESHES[name]) == MESHES[name].topology


@pytest.mark.parametrize("name", MESHES)
def test_oriented(name):
    mesh = MESHES[name]
    start, end = counting.sides(mesh)
    assert len(np.unique(start * len(mesh.vertices) + end)) == len(mesh.corners)


@pytest.mark.parametrize("name", FLAT)
def test_flat_surface_is_closed(name):
    flat = FLAT[name]
    names, count = np.unique(flat.face_edges, return_counts=True)
    assert (count == 2).all()
    assert len(np.unique(flat.faces)) - len(names) + len(flat.faces) == 2 - 2 * flat.genus


@pytest.mark.parametrize("name", FLAT)
def test_flat_edges_have_one_length_and_one_pair_of_ends(name):
    flat = FLAT[name]
    _, side = np.unique(flat.face_edges, return_inverse=True)
    ends = np.sort(np.stack([np.roll(flat.faces, -1, axis=1), np.roll(flat.faces, -2, axis=1)], axis=-1).reshape(-1, 2))
    for values in (np.round(flat.edge_lengths.reshape(-1, 1), 12), ends):
        one = np.zeros((side.max() + 1, values.shape[1]))
        one[side.ravel()] = values
        assert (one[side.ravel()] == values).all()
