"""The mesh families are what they claim to be, by counting without the library."""

import counting
import families
import numpy as np
import pytest

MESHES = {
    "torus of quads": families.torus(12, 9),
    "torus of triangles": families.torus(12, 9, shape="triangles", jitter=0.2),
    "alternating torus": families.torus(12, 10, shape="alternating"),
    "torus knot": families.torus_knot(150, 8),
    "genus 1 block": families.block_with_holes(1),
    "genus 3 block": families.block_with_holes(3, refine=2, jitter=0.2),
    "cage": families.cage(),
    "genus 28 scaffold": families.scaffold(2),
    "ring of straight n-gons": families.square_ring(5),
    "washer of C-shaped n-gons": families.washer(20),
    "cube": families.cube(),
    "tetrahedron": families.tetrahedron(),
    "cylinder": families.cylinder(9, 5),
    "punctured torus": families.punctured_torus(),
    "several": families.united(families.cube(), families.torus(5, 4), families.cylinder(5, 4), families.washer(6)),
    "relabelled": families.relabelled(families.washer(20))[0],
    "mirrored": families.mirrored(families.block_with_holes(2)),
    "subdivided": families.subdivided(families.torus(6, 5, shape="triangles")),
}
FLAT = {
    "torus of two triangles": families.flat_torus(0.3 + 1.1j, 1),
    "jittered flat torus": families.flat_torus(0.3 + 1.1j, 4, jitter=0.2),
    "three squares": families.square_tiled([1, 0, 2], [2, 1, 0], 2),
    "four squares": families.square_tiled([1, 2, 3, 0], [1, 0, 3, 2], 3),
}


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
