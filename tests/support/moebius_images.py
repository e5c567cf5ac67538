"""Meshes without symmetry, and their images under Moebius maps of space."""

import families
import numpy as np

BLOCKS = {g: families.block_with_holes(g, refine=4, jitter=0.1, seed=g) for g in range(2, 7)} | {
    1: families.torus(48, 32, R=1.5, shape="triangles", jitter=0.2)
}


def twisted_block(g):
    """Twisted, so that nothing is its own mirror image."""
    mesh = BLOCKS[g] if g == 1 else families.triangles_of(BLOCKS[g])
    x, y, z = mesh.vertices.T
    return families.replace(mesh, vertices=np.stack([x, y + 0.3 * x * z, z + 0.15 * x * y + 0.05 * x**2], axis=1))


def moebius_image(mesh):
    """By the inversion in a sphere beside the mesh, which reverses the orientation, and a reflection, which does so
    again."""
    centre = mesh.vertices.max(axis=0) + 1.5 * np.ptp(mesh.vertices, axis=0)
    from_centre = mesh.vertices - centre
    inverted = from_centre / (from_centre**2).sum(axis=1, keepdims=True)
    return families.replace(mesh, vertices=inverted * [1, 1, -1])
