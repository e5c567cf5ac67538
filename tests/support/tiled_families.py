"""Tilings of the mesh families, each made once for all tests."""

from functools import cache

import families
import numpy as np
from holomorph import Surface, TiledSurface, automatic_structure
from solved import CLOSED, surface_of

SPHERE = families.geodesic_sphere(9, jitter=0.25)
TORUS = CLOSED["torus of triangles"]
DOUBLE = families.block_with_holes(2, refine=4, jitter=0.2)
HANDLE_AND_HOLE = families.punctured_torus(24, 18)
HOLES = families.punched(families.geodesic_sphere(12, jitter=0.2), 3)
DISK = families.hemisphere(12, jitter=0.2)
CASES = {
    "sphere": (SPHERE, {"poles": 4, "tiles": 40}),
    "torus": (TORUS, {"poles": 4, "tiles": 60}),
    "torus of quads": (CLOSED["torus of quads"], {"poles": 3, "tiles": 60}),
    "torus without poles": (TORUS, {"poles": 0, "tiles": 200, "direction": None}),
    "genus 2": (DOUBLE, {"poles": 4, "tiles": 128}),
    "genus 2, hexagonal": (DOUBLE, {"poles": 4, "tiles": 128, "lattice": "hex"}),
    "sphere, brick": (SPHERE, {"poles": 4, "tiles": 40, "lattice": "brick"}),
    "handle and hole": (HANDLE_AND_HOLE, {"poles": 2, "tiles": 100}),
    "holes, straight": (HOLES, {"poles": 2, "tiles": 60, "boundary": "straight"}),
    "holes, free": (HOLES, {"poles": 2, "tiles": 60, "boundary": "free"}),
    "disk": (DISK, {"poles": 3, "tiles": 40}),
    "sphere, evened": (SPHERE, {"poles": 4, "tiles": 40, "evenness": 0.5}),
    "torus, evened": (TORUS, {"poles": 4, "tiles": 60, "evenness": 1}),
    "genus 2, evened": (DOUBLE, {"poles": 4, "tiles": 128, "evenness": 0.5}),
    "handle and hole, evened": (HANDLE_AND_HOLE, {"poles": 2, "tiles": 100, "evenness": 0.5}),
    "holes, straight, evened": (HOLES, {"poles": 2, "tiles": 60, "boundary": "straight", "evenness": 1}),
    "holes, free, evened": (HOLES, {"poles": 2, "tiles": 60, "boundary": "free", "evenness": 0.5}),
}
# Beside these, for what is made of the tiles.
MORE = {
    "sphere with two poles": (SPHERE, {"poles": 2, "tiles": 50}),
    "genus 2 without poles": (DOUBLE, {"poles": 0, "tiles": 512}),
    "genus 3": (families.block_with_holes(3, refine=3, jitter=0.2), {"poles": 4, "tiles": 400}),
    "genus 5": (families.block_with_holes(5, refine=2, jitter=0.2), {"poles": 6, "tiles": 600}),
    "knot": (CLOSED["torus knot"], {"poles": 0, "tiles": 700}),
}


@cache
def tiling(name):
    mesh, options = (CASES | MORE)[name]
    return automatic_structure(surface_of(mesh)).tile(**options)


@cache
def tiled(name):
    made = tiling(name)
    return TiledSurface(surface_of((CASES | MORE)[name][0]), made.uv, made.lattice)


def renumbered(on):
    """The same with vertices, triangles and the corners of these in another order."""
    numbers = np.random.default_rng(4)
    triangles, corners = on.surface.triangles, on.surface.triangle_corners
    vertex, order = numbers.permutation(len(on.surface.vertices)), numbers.permutation(len(triangles))
    turned = (np.arange(3) + numbers.integers(0, 3, (len(triangles), 1))) % 3
    vertices = np.empty_like(on.surface.vertices)
    vertices[vertex] = on.surface.vertices
    faces = np.take_along_axis(vertex[triangles], turned, 1)[order]
    uv = on.uv[np.take_along_axis(corners, turned, 1)[order].ravel()]
    return TiledSurface(Surface(vertices, faces), uv, on.lattice)


def same_points(a, b, distance):
    """Whether each point of one list is near one of the other: as many in both."""
    between = np.linalg.norm(a[:, None] - b, axis=2)
    return len(a) == len(b) and max(between.min(axis=0).max(), between.min(axis=1).max()) < distance


EXACT = 1e-12


def jumps(mesh, uv, poles):
    """(#E, 2, 2) differences of the UVs of the two polygons at each inner edge, at both of its ends; without edges that
    end at a pole."""
    sizes = np.diff(mesh.offsets)
    first = np.repeat(mesh.offsets[:-1], sizes)
    here = np.arange(len(mesh.corners))
    after = first + (here - first + 1) % np.repeat(sizes, sizes)
    start, end = mesh.corners[here], mesh.corners[after]
    key, back = start * len(mesh.vertices) + end, end * len(mesh.vertices) + start
    order = np.argsort(key)
    place = np.searchsorted(key[order], back)
    found = (place < len(key)) & (key[order][np.minimum(place, len(key) - 1)] == back)
    found &= (start < end) & ~np.isin(start, poles) & ~np.isin(end, poles)
    other = order[place[found]]
    mine = here[found]
    return np.stack([uv[mine] - uv[after[other]], uv[after[mine]] - uv[other]], axis=1)
