"""Disks with three vertices on their boundary, and inside none or none with room for a star."""

import holomorph
import numpy as np
import pytest
from holomorph.coarse_disk import CoarseDiskMap, FlatTriangle


def rotated(points):
    """In general position in space."""
    a, b = 0.7, -0.4
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    tilt = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    return np.asarray(points, float) @ (turn @ tilt).T + (3, -1, 2)


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
def test_a_triangle_is_laid_flat(scale):
    corners = scale * rotated([[0, 0, 0], [3, 0, 0], [1, 2, 0]])
    structure = holomorph.conformal_structure(holomorph.Surface(corners, [[0, 1, 2]]))
    assert isinstance(structure, FlatTriangle)
    uv = structure.uv(structure.balanced_coefficients())
    sides = [np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1) for x in (uv, corners)]
    assert sides[0] == pytest.approx(sides[1], rel=1e-12)
    quality = structure.quality(uv)
    assert quality.mean_angle == pytest.approx(1, abs=1e-12) and not quality.flipped.any()
    assert structure.flip_count == 0 and len(structure.seams) == 0 and structure.invariants() == {}
    assert structure.description


# Triangles around one vertex inside, and around three.
TENT = rotated([[0, 0, 0], [3, 0, 0], [1, 2, 0], [1.2, 0.7, 0.5]]), [[0, 1, 3], [1, 2, 3], [2, 0, 3]]
NESTED = (
    rotated([[0, 0, 0], [6, 0, 0], [2, 5, 0], [2.2, 1, 0.4], [3.5, 1.4, 0.3], [2.4, 2.6, 0.5]]),
    [[3, 4, 5], [0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]],
)


@pytest.mark.parametrize(("vertices", "faces"), [TENT, NESTED], ids=["tent", "nested"])
def test_the_centre_gets_room(vertices, faces):
    surface = holomorph.Surface(vertices, faces)
    structure = holomorph.conformal_structure(surface)
    assert isinstance(structure, CoarseDiskMap)
    z = structure.disk_map()
    (centre,) = structure.punctures
    assert centre >= 3 and abs(z[centre]) < 1e-12
    assert np.abs(z[:3]) == pytest.approx(1, rel=1e-12)
    assert np.abs(z[3:]).max() < 1
    # The long sides cut off much of the disk, and vertices may lie beyond them.
    assert structure.quality(structure.uv()).flipped.sum() <= len(faces) / 2
    assert structure.description == f"disk map, centre at vertex {centre}"


def test_loose_vertices_keep_their_numbers():
    vertices, faces = TENT
    surface = holomorph.Surface(np.vstack([[[9, 9, 9]], vertices]), [[v + 1 for v in face] for face in faces])
    structure = holomorph.conformal_structure(surface)
    assert structure.punctures.tolist() == [4]
    assert np.isnan(structure.disk_map()[0])


def test_without_positions_it_is_refused():
    surface = holomorph.Surface.from_edge_lengths(np.array([[0, 1, 2]]), np.ones((1, 3)))
    with pytest.raises(holomorph.TopologyError, match="no room for a centre"):
        holomorph.conformal_structure(surface)
