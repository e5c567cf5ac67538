"""Small meshes of the families by name."""

import families

TORI = [(2, 1, 6, 4), (3, 1, 8, 4), (1, 0.5, 6, 4), (2, 1, 8, 5), (3, 2, 7, 5), (2, 0.5, 9, 3)]

SMALL = {
    **{f"torus {R} {r} {n} {m}": families.torus(n, m, R, r, "triangles") for R, r, n, m in TORI},
    "genus 1 block": families.block_with_holes(1),
    "genus 2 block": families.block_with_holes(2),
    "jittered genus 1 block": families.block_with_holes(1, jitter=0.05),
    "jittered genus 2 block": families.block_with_holes(2, jitter=0.05),
}

MESHES = {
    "torus of quads": families.torus(12, 9),
    "torus of triangles": families.torus(12, 9, shape="triangles", jitter=0.2),
    "alternating torus": families.torus(12, 10, shape="alternating"),
    "torus knot": families.torus_knot(150, 8),
    "genus 1 block": families.block_with_holes(1),
    "genus 3 block": families.block_with_holes(3, refine=2, jitter=0.2),
    "cage": families.cage(),
    "genus 28 scaffold": families.scaffold(2),
    "ring of straight n-gons": families.square_ring(5),
    "washer of C-shaped n-gons": families.washer(20),
    "cube": families.cube(),
    "tetrahedron": families.tetrahedron(),
    "cylinder": families.cylinder(9, 5),
    "punctured torus": families.punctured_torus(),
    "several": families.united(families.cube(), families.torus(5, 4), families.cylinder(5, 4), families.washer(6)),
    "relabelled": families.relabelled(families.washer(20))[0],
    "mirrored": families.mirrored(families.block_with_holes(2)),
    "subdivided": families.subdivided(families.torus(6, 5, shape="triangles")),
}

FLAT = {
    "torus of two triangles": families.flat_torus(0.3 + 1.1j, 1),
    "jittered flat torus": families.flat_torus(0.3 + 1.1j, 4, jitter=0.2),
    "three squares": families.square_tiled([1, 0, 2], [2, 1, 0], 2),
    "four squares": families.square_tiled([1, 2, 3, 0], [1, 0, 3, 2], 3),
}
