"""Which disks are rectangles to the eye: their corners are found on rough, round and wavy borders, and on no others."""

import families
import numpy as np
import pytest
from holomorph import RectangleMap, Surface, _native, automatic_structure, disk_map, rectangle_map
from plane_meshes import grid
from solved import surface_of

WAVES = 8  # of terrain along a side, at most


def terrain(height, seed, n=48):
    """The unit square with heights of this standard deviation."""
    rng = np.random.default_rng(seed)

    def place(x, y):
        z = np.zeros(len(x))
        for waves in np.repeat(np.arange(1, WAVES + 1), 4):
            across, along = 2 * np.pi * waves * rng.normal(size=2)
            z += np.sin(across * x + along * y + rng.uniform(0, 2 * np.pi)) / waves**1.2
        return np.stack([x, y, height * z / z.std()], axis=1)

    return grid(n, n, place, "triangles")


def rough(n, m, noise, seed=0):
    """n x m square cells, each vertex moved by up to this part of their side."""
    rng = np.random.default_rng(seed)

    def place(x, y):
        points = np.stack([x * n / m, y, 0 * x], axis=1)
        points[:, :2] += rng.uniform(-noise, noise, (len(x), 2)) / m
        return points

    return grid(n, m, place, "triangles")


def filled(outline):
    """Rings inside a plane outline, (n, 2), that is seen whole from its centre."""
    count, rings = len(outline), 6
    centre = outline.mean(axis=0)
    plane = np.concatenate([centre[None], *(centre + (outline - centre) * i / rings for i in range(1, rings + 1))])
    faces = [[0, 1 + j, 1 + (j + 1) % count] for j in range(count)]
    for first in range(1, 1 + (rings - 1) * count, count):
        around = [(first + j, first + (j + 1) % count) for j in range(count)]
        faces += [[a, a + count, b + count, b] for a, b in around]
    return families.polygons(np.pad(plane, ((0, 0), (0, 1))), faces, ((0, 1),))


def evenly(corners, count=240):
    """As many points, at equal distances along a polygon."""
    closed = np.concatenate([corners, corners[:1]])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    places = np.linspace(0, length[-1], count, endpoint=False)
    return np.stack([np.interp(places, length, column) for column in closed.T], axis=1)


def regular(sides, count):
    turn = 2 * np.pi * np.arange(sides) / sides
    return evenly(np.stack([np.cos(turn), np.sin(turn)], axis=1), count)


def rounded(width, height, radius):
    """A rectangle around 0 with round corners."""
    turn = np.linspace(0, np.pi / 2, 20)
    arc = radius * np.exp(1j * turn)
    signs = (1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j)
    centres = [complex(s.real * (width / 2 - radius), s.imag * (height / 2 - radius)) for s in signs]
    outline = np.concatenate([centre + arc * 1j**quarter for quarter, centre in enumerate(centres)])
    return evenly(np.stack([outline.real, outline.imag], axis=1))


def cells(rows):
    return families.flat_cells(np.array([[c == "#" for c in row] for row in rows]), 1.0, topology=((0, 1),))


def tray(depth, n=16):
    """A square floor, and walls that meet."""

    def place(x, y):
        x, y = 2 * x - 1, 2 * y - 1
        return np.stack([x, y, depth * np.maximum(0, np.maximum(abs(x), abs(y)) - 0.5)], axis=1)

    return grid(n, n, place)


def folded(n=20):
    """Half a cylinder: its arcs are straight on it."""
    return grid(n, n, lambda x, y: np.stack([np.cos(np.pi * x), 2 * y, np.sin(np.pi * x)], axis=1), "triangles")


RECTANGLES = {
    **{f"terrain of height {height}, {seed}": terrain(height, seed) for height in (0.02, 0.1) for seed in range(3)},
    **{f"noise {noise}": rough(32, 20, noise) for noise in (0.1, 0.3, 0.45)},
    "fine noise": rough(60, 60, 0.45, seed=1),
    **{f"rounded by {radius}": filled(rounded(1.5, 1, radius)) for radius in (0.02, 0.1, 0.2)},
    "strip of one cell": grid(40, 1, lambda x, y: np.stack([40 * x, y, 0 * x], axis=1)),
    "half a cylinder": folded(),
    "two cells": grid(2, 1),
}
OTHERS = {
    **{f"{sides}-gon": filled(regular(sides, max(sides, 60))) for sides in (3, 5, 6, 8, 12, 512)},
    "hexagon of six": filled(regular(6, 6)),
    **{f"stadium {length} long": filled(rounded(length, 1, 0.5 - 1e-9)) for length in (2, 4, 10)},
    "ellipse": filled(evenly(regular(200, 200) * [3, 1])),
    "L": cells(["######"] * 3 + ["###..."] * 3),
    "T": cells(["######"] * 2 + ["..##.."] * 4),
    "plus": cells(["..##.."] * 2 + ["######"] * 2 + ["..##.."] * 2),
    "hemisphere": families.hemisphere(10),
    "deep tray": tray(4.0),
}


def corner_points(mesh):
    """The corners that were found; no triangle is lost to a side."""
    structure = automatic_structure(surface_of(mesh))
    assert isinstance(structure, RectangleMap) and not len(structure.collapsed_triangles)
    return mesh.vertices[structure.corners]


@pytest.mark.parametrize("name", RECTANGLES)
def test_rectangles_are_recognised(name):
    mesh = RECTANGLES[name]
    found = corner_points(mesh)
    if name == "half a cylinder":
        assert np.allclose(np.abs(found[:, 0]), 1) and set(found[:, 1].round(9)) == {0, 2}
        return
    low, high = mesh.vertices[:, :2].min(axis=0), mesh.vertices[:, :2].max(axis=0)
    box = np.stack([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    distances = np.linalg.norm(found[:, None, :2] - box, axis=2)
    assert sorted(distances.argmin(axis=1)) == [0, 1, 2, 3]
    assert distances.min(axis=1).max() < 0.1 * np.linalg.norm(high - low)


@pytest.mark.parametrize("name", OTHERS)
def test_other_shapes_are_no_rectangles(name):
    """Where a disk map is uneven, quarters of the boundary may still become the corners of a rectangle."""
    assert _native.clear_corners(surface_of(OTHERS[name])._native) is None


def test_terrain_is_as_even_as_a_rectangle_can_be():
    mesh = terrain(0.1, 0)
    surface = surface_of(mesh)
    qualities = []
    for structure in (rectangle_map(surface), disk_map(surface, len(mesh.vertices) // 2)):
        qualities.append(structure.quality(structure.uv([])))
    found, disk = qualities
    assert found.density_ratio < 0.5 * disk.density_ratio and found.mean_angle < disk.mean_angle


@pytest.mark.parametrize("factor", [1e-30, 1e30])
def test_size_and_place_do_not_matter(factor):
    mesh = terrain(0.1, 1)
    corners = automatic_structure(surface_of(mesh)).corners
    moved = families.moved(mesh, scale=factor)
    assert (automatic_structure(surface_of(moved)).corners == corners).all()


def test_a_rough_border_without_positions_is_recognised():
    surface = surface_of(rough(32, 20, 0.45))
    of_lengths = Surface.from_edge_lengths(surface.triangles, side_lengths(surface))
    assert isinstance(automatic_structure(of_lengths), RectangleMap)


def side_lengths(surface):
    """(#T, 3), entry i opposite corner i."""
    points = surface.vertices[surface.triangles]
    return np.linalg.norm(np.roll(points, -1, axis=1) - np.roll(points, 1, axis=1), axis=2)
