"""Conformal structures of the mesh families, each computed once for all tests."""

from functools import cache

import families
from holomorph import Surface, conformal_structure

# Arrays of a structure that do not depend on the calls made before.
RESULTS = [
    "edges",
    "intersection_matrix",
    "canonical_basis",
    "harmonic_forms",
    "holomorphic_forms",
    "gram_matrix",
    "period_matrix",
    "seams",
]
CLOSED = {
    "torus of quads": families.torus(24, 18, jitter=0.2),
    "torus of triangles": families.torus(24, 18, shape="triangles", jitter=0.3),
    "even torus": families.torus(24, 18, shape="triangles"),
    "thin torus": families.torus(40, 8, R=1.0, r=0.02, shape="triangles"),
    "torus knot": families.torus_knot(200, 10),
    "genus 1 block": families.block_with_holes(1),
    "genus 2 block": families.block_with_holes(2, refine=3, jitter=0.25),
    "genus 3 block": families.block_with_holes(3, refine=2, jitter=0.2),
    "genus 8 block": families.block_with_holes(8),
    "cage": families.cage(),
    "genus 28 scaffold": families.scaffold(2),
    "ring of straight n-gons": families.square_ring(5),
    "washer of C-shaped n-gons": families.washer(20),
    "partly reversed": families.partly_reversed(families.block_with_holes(2, refine=2)),
    "slivers": families.torus(60, 5, R=1.0, r=0.9, shape="alternating", jitter=0.4),
}
FLAT = {
    "torus of two triangles": families.flat_torus(0.3 + 1.1j, 1),
    "jittered flat torus": families.flat_torus(0.3 + 1.1j, 6, jitter=0.25),
    "three squares": families.square_tiled([1, 0, 2], [2, 1, 0], 3),
    "four squares": families.square_tiled([1, 2, 3, 0], [1, 0, 3, 2], 3),
}

BOUNDED = {
    "one layer of quads": families.cylinder(8, 2),
    "tube": families.cylinder(24, 9),
    "square minus square": families.square_minus_square(4, jitter=0.2),
    "punctured torus": families.punctured_torus(),
    "torus of triangles with 3 holes": families.punched(families.torus(24, 18, shape="triangles", jitter=0.3), 3),
    "torus with chords": families.chord_torus(),
    "ball with 2 holes": families.punched(families.block_with_holes(0, refine=4, jitter=0.2), 2),
    "ball with 5 holes": families.punched(families.block_with_holes(0, refine=4, jitter=0.2), 5, seed=1),
    "ball with 11 holes": families.punched(families.block_with_holes(0, refine=4, jitter=0.2), 11, seed=2),
    "genus 2 with 1 hole": families.punched(families.block_with_holes(2, refine=3, jitter=0.25), 1),
    "genus 2 with 5 holes": families.punched(families.block_with_holes(2, refine=2, jitter=0.1), 5),
    "genus 3 with 2 holes": families.punched(families.block_with_holes(3, refine=2, jitter=0.2), 2),
    "partly reversed": families.partly_reversed(families.punched(families.block_with_holes(1, refine=2), 3)),
}
BOUNDED_FLAT = {
    "flat torus without a triangle": families.without_triangle(families.flat_torus(0.3 + 1.1j, 6, jitter=0.25), 40),
    "three squares without a triangle": families.without_triangle(families.square_tiled([1, 0, 2], [2, 1, 0], 4), 13),
}


def surface_of(mesh):
    """The surface of a `Mesh` or a `FlatSurface`."""
    if isinstance(mesh, families.FlatSurface):
        return Surface.from_edge_lengths(mesh.faces, mesh.edge_lengths, mesh.face_edges)
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


@cache
def solved(name):
    return conformal_structure(surface_of((CLOSED | FLAT)[name]))


@cache
def solved_bounded(name):
    return conformal_structure(surface_of((BOUNDED | BOUNDED_FLAT)[name]))
