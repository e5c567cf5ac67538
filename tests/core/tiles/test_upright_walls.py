"""Faces of parts as CAD has them, long and flat, with vertices on their rims alone: heights go straight up from them,
but within a depth of a sharp edge."""

import numpy as np
import pytest
from holomorph import Surface, automatic_map

DEPTH = 1.0


def tube(sides, outer=20.0, inner=13.0, height=30.0):
    """Four rims, and quads between them."""
    angle = 2 * np.pi * np.arange(sides) / sides
    rims = [(outer, 0), (outer, height), (inner, height), (inner, 0)]
    points = [np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle + z], axis=1) for r, z in rims]
    here, there = np.arange(sides), (np.arange(sides) + 1) % sides
    faces = [np.stack([i * sides + here, i * sides + there, j * sides + there, j * sides + here], axis=1)
             for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))]  # fmt: skip
    return Surface(np.concatenate(points), np.concatenate(faces))


def cylinder(sides):
    angle = 2 * np.pi * np.arange(sides) / sides
    rim = np.stack([20 * np.cos(angle), 20 * np.sin(angle), 0 * angle], axis=1)
    walls = [[k, (k + 1) % sides, sides + (k + 1) % sides, sides + k] for k in range(sides)]
    return Surface(np.concatenate([rim, rim + (0, 0, 40)]), [[*range(sides)][::-1], [*range(sides, 2 * sides)], *walls])


def cube(parts=3, side=30.0):
    """With a grid of quads on each face."""
    grid = np.arange(parts + 1)
    points = {at: k for k, at in enumerate(p for p in np.ndindex(*[parts + 1] * 3) if {0, parts} & set(p))}
    faces = []
    for axis, at in ((axis, at) for axis in range(3) for at in (0, parts)):
        for i, j in np.ndindex(parts, parts):
            corners = [np.roll([at, i + a, j + b], axis) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            faces.append([points[tuple(corner)] for corner in (corners if at else corners[::-1])])
    return Surface(np.array([*points], float) * side / parts, faces), grid


SURFACES = {
    "round tube": lambda: tube(64),
    "six-sided tube": lambda: tube(6),
    "twelve-sided tube": lambda: tube(12),
    "square tube": lambda: tube(4),
    "cylinder": lambda: cylinder(64),
    "cube": lambda: cube()[0],
}


HOLLOW = {"six-sided tube": 6, "twelve-sided tube": 12, "square tube": 4}  # numbers of their inner walls


def raised(surface, level=0.0):
    picture = np.full((32, 32), 0.3)
    picture[8:24, 8:24] = 1
    return automatic_map(surface, main="seamless", tiles=24).tiled.relief(picture, DEPTH, level=level)


def normals(points, triangles):
    cross = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]]
    )
    return cross / np.linalg.norm(cross, axis=1, keepdims=True)


def sharp_edges(surface):
    """(n, 2, 3) ends of the edges between triangles that meet at an angle."""
    sides = np.concatenate([surface.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    keys = np.sort(sides, axis=1) @ (len(surface.vertices), 1)
    order = np.argsort(keys, kind="stable")
    triangle = np.tile(np.arange(len(surface.triangles)), 3)[order].reshape(-1, 2)
    normal = normals(surface.vertices, surface.triangles)[triangle]
    is_sharp = np.einsum("ij,ij->i", normal[:, 0], normal[:, 1]) < np.cos(np.radians(29))
    return surface.vertices[sides[order[::2]][is_sharp]]


def distances(points, edges):
    least = np.full(len(points), np.inf)
    for a, b in edges:
        along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        least = np.minimum(least, np.linalg.norm(points - a - along[:, None] * (b - a), axis=1))
    return least


@pytest.mark.parametrize("name", SURFACES)
def test_heights_go_straight_up_but_within_a_depth_of_a_sharp_edge(name):
    """But for the walls of holes with hollow edges, whose two sides come nearer to each other."""
    surface = SURFACES[name]()
    made = raised(surface)
    sharp = sharp_edges(surface)
    moved = (made.vertices - made.base)[made.triangles]
    length = np.linalg.norm(moved, axis=2)
    is_away = (distances(made.base, sharp)[made.triangles] > made.depth) & (length > 0)
    if name in HOLLOW:
        is_away[np.isin(made.faces, range(2 * HOLLOW[name], 3 * HOLLOW[name]))] = False
    up = np.einsum("tkx,tx->tk", moved, normals(made.base, made.triangles))
    lean = np.degrees(np.arccos(np.clip(up / np.maximum(length, 1e-9), -1, 1)))
    facets = 180 / 64 if name in ("round tube", "cylinder") else 0  # to whose edges the smooth wall's normals turn
    assert is_away.sum() > 1000
    assert lean[is_away].max() <= facets + 1e-4


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("name", SURFACES)
def test_all_faces_stay_parallel_to_themselves(name, level):
    """Each is moved by the height, also at the vertices of rims."""
    made = raised(SURFACES[name](), level)
    moved = (made.vertices - made.base)[made.triangles]
    up = np.einsum("tkx,tx->tk", moved, normals(made.base, made.triangles))
    expected = made.depth * made.heights[made.triangles]
    facets = 1 / np.cos(np.pi / 64) - np.cos(np.pi / 64) if name in ("round tube", "cylinder") else 0
    assert np.abs(up - expected).max() <= facets + 1e-5


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("name", SURFACES)
def test_it_is_closed_and_does_not_cross_itself(name, level):
    made = raised(SURFACES[name](), level)
    sides = np.concatenate([made.triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    count = len(made.base)
    assert np.array_equal(np.sort(sides @ (count, 1)), np.sort(sides @ (1, count)))
    assert not len(made.crossings)
    assert not made.is_full
