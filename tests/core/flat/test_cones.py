"""Cone points: disks cut open until their flat maps are even."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Cancelled, Surface, TopologyError, cut_to_cones, free_boundary_map
from island_checks import assert_same_faces
from shared_data import shared_folder
from solved import surface_of

FINGERS = ((-0.4, -0.3), (0.4, -0.2), (0.0, 0.4))


def glove(n=30):
    """The unit disk with a finger at each place."""
    points, faces = families.hexagonal_disk(n, jitter=0.2)
    height = sum(np.exp(-((points - finger) ** 2).sum(axis=1) / 0.02) for finger in FINGERS)
    return families.uniform(np.column_stack([points, height]), faces, ((0, 1),))


def flat_disk(n=5):
    points, faces = families.hexagonal_disk(n, jitter=0.2)
    return surface_of(families.uniform(np.column_stack([points, np.zeros(len(points))]), faces, ((0, 1),)))


def flat_map(disk):
    return free_boundary_map(disk)


def ratio(structure):
    return structure.quality(structure.uv()).density_ratio


@pytest.mark.parametrize("most", [2.0, 4.0])
def test_lengths_change_by_no_more_than_the_factor(most):
    surface = surface_of(glove())
    before, cut = flat_map(surface), cut_to_cones(surface, most)
    after = flat_map(cut)
    assert (cut.genus, cut.boundary_count) == (0, 1)
    assert_same_faces(surface, (cut,))
    assert np.abs(np.log(before.scale_factors)).max() > np.log(4)
    assert np.abs(np.log(after.scale_factors)).max() <= np.log(most)
    assert ratio(after) < ratio(before)
    assert not after.quality(after.uv()).flipped.any()


def test_each_finger_gets_a_cut():
    """A vertex at its tip comes to lie on the boundary."""
    mesh = glove()
    surface = surface_of(mesh)
    cut = cut_to_cones(surface, 3.0)
    on_boundary = cut.vertex_index[boundary_vertices(cut)]
    for finger in FINGERS:
        at_tip = (np.linalg.norm(mesh.vertices[:, :2] - finger, axis=1) < 0.1) & (mesh.vertices[:, 2] > 0.8)
        assert np.isin(np.flatnonzero(at_tip), on_boundary).any()


def boundary_vertices(disk):
    sides = np.stack([disk.triangles, np.roll(disk.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    rows, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    return np.unique(rows[count == 1])


def test_a_flat_disk_is_not_cut():
    surface = flat_disk()
    assert cut_to_cones(surface, 1.01) is surface


def test_numbers_and_sizes_do_not_matter():
    mesh = glove(20)
    tall = replace(mesh, vertices=mesh.vertices * 1e6)
    counts = [len(cut_to_cones(surface_of(each), 2.0).vertices) for each in (mesh, tall, families.moved(mesh))]
    assert len(set(counts)) == 1


def test_a_hand_becomes_even():
    surface = Surface.read(shared_folder("meshes") / "hand_lowres_b1.obj")
    assert ratio(flat_map(surface)) > 1e6
    assert ratio(flat_map(cut_to_cones(surface, 2.0))) < 5


@pytest.mark.parametrize(
    "mesh",
    [families.torus(8, 6), families.cylinder(8, 4), families.geodesic_sphere(2)],
    ids=["torus", "tube", "sphere"],
)
def test_other_surfaces_are_refused(mesh):
    with pytest.raises(TopologyError, match="cone points need a disk"):
        cut_to_cones(surface_of(mesh))


@pytest.mark.parametrize("factor", [1, 0.5, 0, -2, float("nan"), float("inf"), "much"])
def test_factors_that_are_none(factor):
    with pytest.raises((ValueError, TypeError), match="most_stretch"):
        cut_to_cones(flat_disk(), factor)


def test_it_is_cancelled():
    with pytest.raises(Cancelled):
        cut_to_cones(surface_of(glove()), 2.0, progress=lambda fraction, stage: False)
