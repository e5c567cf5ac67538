"""Conformal maps keep the orientation, on surfaces that are their own mirror images too."""

import families
import numpy as np
import pytest
from holomorph import conformal_map, conformal_structure
from solved import surface_of


def cells(*holes, size, per_cell=4, seed=0):
    """A flat rectangle of cells with square holes of one cell."""
    mask = np.ones((size[0] * per_cell, size[1] * per_cell), dtype=bool)
    for row, column in holes:
        mask[row * per_cell : (row + 1) * per_cell, column * per_cell : (column + 1) * per_cell] = False
    return families.triangles_of(families.flat_cells(mask, 1 / per_cell, jitter=0.2, seed=seed))


SYMMETRIC = {
    "tube": lambda seed: families.triangles_of(families.cylinder(20 + seed, 7)),
    "square ring": lambda seed: cells((1, 1), size=(3, 3), seed=seed),
    "pants": lambda seed: cells((1, 1), (1, 3), size=(3, 5), seed=seed),
    "three holes": lambda seed: cells((1, 1), (1, 3), (3, 2), size=(5, 5), seed=seed),
}
IMAGES = {
    "moved": families.moved,
    "numbered anew": lambda mesh: families.relabelled(mesh)[0],
    "mirrored": families.mirrored,
}


def kept_part(found, a, b):
    """Signed area of the images of the first surface's triangles, on the sides that the second's face to, over their
    area: 1 where all keep the orientation, -1 where none does."""
    images = found.of(b.surface.vertices)[a.surface.triangles]
    normals = np.cross(images[:, 1] - images[:, 0], images[:, 2] - images[:, 0])
    there = b._of_surface(b._triangulation.triangles)[found.triangles[a.surface.triangles[:, 0]]]
    sides = b.surface.vertices[there]
    facing = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    signed = (normals * facing).sum(axis=1) / np.linalg.norm(facing, axis=1)
    return signed.sum() / np.abs(signed).sum()


@pytest.mark.parametrize("image", IMAGES)
@pytest.mark.parametrize("name", SYMMETRIC)
def test_the_orientation_is_kept(name, image):
    mesh = SYMMETRIC[name](0)
    a, b = (conformal_structure(surface_of(each)) for each in (mesh, IMAGES[image](mesh)))
    found = conformal_map(a, b, tolerance=0.05)
    assert found.equivalence.verdict == "equivalent"
    assert kept_part(found, a, b) > 0.95


@pytest.mark.parametrize("name", ["tube", "square ring", "pants"])
def test_the_error_of_the_periods_is_told(name):
    a, b = (conformal_structure(surface_of(SYMMETRIC[name](seed))) for seed in (0, 4))
    found = conformal_map(a, b, tolerance=0.05)
    assert kept_part(found, a, b) > 0.95
    assert found.residual >= found.equivalence.residual > 0
