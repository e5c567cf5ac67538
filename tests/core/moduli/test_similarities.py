"""Similar triangulations: found however they are numbered, and only where all angles are the same."""

import families
import numpy as np
import pytest
from holomorph import Surface, _native
from moebius_images import moebius_image
from solved import surface_of

MESHES = {
    "torus": families.triangles_of(families.torus(12, 8, jitter=0.2)),
    "regular torus": families.triangles_of(families.torus(12, 8)),
    "handles": families.triangles_of(families.block_with_holes(2, refine=2, jitter=0.2)),
    "holes": families.punched(families.triangles_of(families.block_with_holes(1, refine=4, jitter=0.1)), 3, seed=1),
    "cylinder": families.triangles_of(families.cylinder(8, 4)),
}


def similarity(a, b, sign=1):
    return _native.similarity(surface_of(a)._native, surface_of(b)._native, sign, None)


@pytest.mark.parametrize("name", MESHES)
def test_moved_and_renumbered_meshes_are_similar(name):
    mesh = MESHES[name]
    moved = families.moved(mesh, scale=1e3)
    found, other = similarity(mesh, mesh), similarity(mesh, families.relabelled(moved)[0])
    assert found.is_exact and other.is_exact and max(found.dilatation, other.dilatation) < 1e-9


@pytest.mark.parametrize("name", MESHES)
def test_mirrored_meshes_are_similar_with_the_other_orientation(name):
    mesh = MESHES[name]
    mirrored = families.mirrored(mesh)
    assert similarity(mesh, mirrored, -1).is_exact
    if name in ("torus", "handles", "holes"):
        assert similarity(mesh, mirrored) is None


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("part", [1e-6, 1e-10, 1e-13])
def test_one_moved_vertex_is_seen(name, part):
    """Wherever it is: the walk looks at all triangles."""
    mesh = MESHES[name]
    for v in np.linspace(0, len(mesh.vertices) - 1, 7).astype(int):
        vertices = mesh.vertices.copy()
        vertices[v] *= 1 + part
        found = similarity(mesh, families.replace(mesh, vertices=vertices))
        assert not found.is_exact and found.dilatation > part / 10


def test_stretched_meshes_are_as_far_as_they_are_stretched():
    """A flat annulus, x by a factor: the same linear map of each triangle, and the same log of its dilatation."""
    mesh = families.triangles_of(families.square_minus_square(2, jitter=0.2))
    for stretch, is_similar in ((1e-13, True), (1e-9, True), (9e-3, True), (1.1e-2, False), (0.1, False)):
        found = similarity(mesh, families.replace(mesh, vertices=mesh.vertices * [1 + stretch, 1, 1]))
        if is_similar:
            assert not found.is_exact
            assert np.log1p(stretch) <= found.dilatation < np.log1p(stretch) * (1 + 1e-9) + 1e-11
        else:
            assert found is None


def test_a_mesh_with_a_triangle_without_area_is_similar_to_itself():
    mesh = MESHES["torus"]
    a, b, c = mesh.corners[:3]  # the middle of a side becomes a vertex, of the first triangle alone
    vertices = np.vstack([mesh.vertices, (mesh.vertices[a] + mesh.vertices[b]) / 2])
    new = len(mesh.vertices)
    faces = np.vstack([[[a, new, c], [new, b, c], [a, b, new]], mesh.corners[3:].reshape(-1, 3)])
    surface = Surface(vertices, faces)
    assert len(surface.repairs.zero_area_faces) == 1
    found = _native.similarity(surface._native, surface._native, 1, None)
    assert found.is_exact and found.dilatation == 0


def test_other_surfaces_are_not_similar():
    torus = MESHES["torus"]
    assert similarity(torus, moebius_image(torus)) is None
    assert similarity(torus, families.triangles_of(families.torus(8, 12, jitter=0.2))) is None
    assert similarity(torus, families.subdivided(torus)) is None
