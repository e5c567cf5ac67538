"""Meshes that mutations begin with: of every topology, and as small as can be."""

import families

STARTS = (
    families.tetrahedron(),
    families.cube(),
    families.geodesic_sphere(1),
    families.spun(4, 3),
    families.spun(3, 2, "fan"),
    families.hemisphere(1),
    families.hemisphere(2),
    families.cylinder(5, 3),
    families.cylinder(3, 2),
    families.cube_corner(2),
    families.torus(4, 3),
    families.torus(5, 4, shape="triangles"),
    families.square_ring(2),
    families.washer(3),
    families.punctured_torus(5, 4),
    families.block_with_holes(2),
    families.punched(families.block_with_holes(1), 2),
    families.united(families.torus(4, 3), families.cube()),
)
