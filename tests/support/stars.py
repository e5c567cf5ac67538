"""Poles and the triangles around them."""

import numpy as np


def vertex_at(mesh, point):
    return int(np.argmin(np.linalg.norm(mesh.vertices - point, axis=1)))


def triangulation(structure):
    """Triangles and their corners of the structure's own triangulation."""
    return structure._triangulation.triangles, structure._triangulation.triangle_corners


def star_triangles(structure):
    return np.isin(triangulation(structure)[0], structure.poles).any(axis=1)


def neighbours(structure, pole):
    """The link of a pole, counter-clockwise."""
    triangles, _ = triangulation(structure)
    rows, place = np.nonzero(triangles == pole)
    after = {triangles[t][(i + 1) % 3]: triangles[t][(i + 2) % 3] for t, i in zip(rows, place, strict=True)}
    link = [min(after)]
    while after[link[-1]] != link[0]:
        link.append(after[link[-1]])
    assert len(link) == len(after)
    return np.array(link)


def mean_angle_off_the_stars(structure):
    quality = structure.quality(structure.uv(structure.balanced_coefficients()))
    triangles, _ = triangulation(structure)
    p = structure.surface.vertices[triangles]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    off = ~star_triangles(structure)
    return (quality.angle * area)[off].sum() / area[off].sum()
