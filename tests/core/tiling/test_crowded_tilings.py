"""Poles on disks with long arms, where the density of a single pole falls to nothing: one is wanted in each arm."""

import numpy as np
import pytest
from holomorph import Surface, Tiler

STEP = 0.2


def squares(cells):
    """A flat surface of the marked cells of a grid."""
    i, j = np.nonzero(cells)
    n = cells.shape[1] + 1
    corners = np.stack([(i + x) * n + j + y for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], 1)
    used, faces = np.unique(corners, return_inverse=True)
    vertices = np.stack([*(STEP * np.array(divmod(used, n))), np.zeros(len(used))], 1)
    return vertices, faces.reshape(-1, 4)


def cross(length):
    """Four arms, 1 wide."""
    arm, width = round(length / STEP), round(1 / STEP)
    middle = (np.arange(2 * arm + width) >= arm) & (np.arange(2 * arm + width) < arm + width)
    return squares(middle[:, None] | middle)


def strip(length):
    return squares(np.ones((round(length / STEP), round(1 / STEP)), bool))


def noisy(mesh, seed):
    """Moved by about what single precision is off by."""
    vertices, faces = mesh
    noise = np.random.default_rng(seed).uniform(-1e-7, 1e-7, (len(vertices), 2))
    return Surface(vertices + np.pad(noise, ((0, 0), (0, 1))), faces)


@pytest.mark.parametrize("seed", range(3))
def test_every_arm_has_its_poles(seed):
    """The size range was 5e5, or 41, as the rounding of the coordinates would have it."""
    assert Tiler(noisy(cross(5), seed), 8).poles.size_range < 100


@pytest.mark.parametrize(("poles", "most"), [(4, 3e4), (8, 100)])
def test_poles_along_a_strip(poles, most):
    """Evenly spaced ones, halfway between which the density is exp(-20 pi / #poles) of that at them; it was 1e26 and
    9e7."""
    assert Tiler(noisy(strip(20), 0), poles).poles.size_range < most


def test_there_is_room_on_a_strip():
    """A triangle with a side on the boundary may have a pole at its corner inside."""
    assert len(Tiler(noisy(strip(40), 0), 8).poles.vertices) == 8


def test_single_precision_changes_little(meshes):
    """A surface of genus 4 cut open to a disk. With eight poles the size range was 11 in double precision and 8000
    in single."""
    given = Surface.read(meshes / "fertility_cutseam.obj", strict=True)
    single = Surface(given.vertices.astype(np.float32).astype(float), given.triangles)
    ranges = [Tiler(surface, 8).poles.size_range for surface in (given, single)]
    assert max(ranges) < 32
