"""The conformal map between equivalent surfaces: where it is known, and its angles."""

import sys

import families
import numpy as np
import pytest
from conftest import shared_folder
from holomorph import SolverError, Surface, TopologyError, conformal_map, conformal_structure
from solved import surface_of
from test_conformal_equivalence import moebius_image, triangles


def edge_length(mesh):
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


def structures(*meshes):
    return [conformal_structure(surface_of(mesh)) for mesh in meshes]


@pytest.mark.parametrize("image", [moebius_image, families.moved, families.mirrored, families.subdivided])
def test_vertices_are_found_again(image):
    """Genus 3 without symmetry: the map is the only one, and its vertices are known."""
    mesh = triangles(3)
    other = image(mesh)
    found = conformal_map(*structures(mesh, other))
    distance = np.linalg.norm(found.of(other.vertices) - other.vertices[: len(mesh.vertices)], axis=1)
    assert np.median(distance) < 0.25 * edge_length(mesh) * np.ptp(other.vertices) / np.ptp(mesh.vertices)
    assert found.residual < 0.03


def test_thin_arms_do_not_mislead():
    """On them wrong starts fit as well as right ones, and a vertex may be caught on the wrong side of one."""
    surface = Surface.read(shared_folder("meshes") / "fertility_ngon_g4.obj")
    mesh = families.uniform(surface.vertices, surface.triangles)
    other = moebius_image(mesh)
    found = conformal_map(*structures(mesh, other), tolerance=0.02)
    distance = np.linalg.norm(found.of(other.vertices) - other.vertices, axis=1)
    assert distance.max() < 3e-3 * np.ptp(other.vertices)
    assert found.residual < 1e-3


def test_tori_are_mapped_with_their_angles():
    """Many maps are conformal; whichever is found has little distortion."""
    mesh = families.torus(48, 32, R=1.5, shape="triangles", jitter=0.2)
    other = families.moved(families.torus(64, 24, R=1.5, shape="triangles", jitter=0.2, seed=5))
    found = conformal_map(*structures(mesh, other), tolerance=0.02)
    faces = mesh.corners.reshape(-1, 3)
    images = found.of(other.vertices)
    first, second = (frames(points[faces]) for points in (mesh.vertices, images))
    values = np.linalg.svd(second @ np.linalg.inv(first), compute_uv=False)
    assert np.median(values[:, 0] / values[:, 1]) < 1.2  # both meshes interpolate


def frames(corners):
    """(#T, 2, 2) sides 1 and 2 of triangles in their own planes."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    x = a / np.linalg.norm(a, axis=1, keepdims=True)
    along = (b * x).sum(axis=1)
    height = np.linalg.norm(b - along[:, None] * x, axis=1)
    zero = np.zeros(len(a))
    return np.moveaxis(np.array([[np.linalg.norm(a, axis=1), along], [zero, height]]), 2, 0)


def test_a_map_that_does_not_fit_is_refused(monkeypatch):
    monkeypatch.setattr(sys.modules["holomorph.conformal_map"], "MOST_RESIDUAL", 0.0)
    with pytest.raises(SolverError, match="no map was found"):
        conformal_map(*structures(triangles(2), moebius_image(triangles(2))))


def test_refusals():
    torus, other = structures(families.torus(12, 8), families.torus(12, 8, R=3.0))
    with pytest.raises(TopologyError, match="there is no map to be made; Not equivalent"):
        conformal_map(torus, other)
    with pytest.raises(TypeError, match="not of a BoundedStructure"):
        conformal_map(torus, *structures(families.cylinder(8, 4)))
