"""The same mesh in another guise."""

from dataclasses import replace

import numpy as np

from families.mesh import Mesh, uniform
from families.tori import cut_quads


def united(*meshes):
    """All meshes side by side as one, in order."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corner_starts = np.cumsum([0, *(len(mesh.corners) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices + 10.0 * k for k, mesh in enumerate(meshes)]),
        np.concatenate([mesh.corners + start for mesh, start in zip(meshes, starts[:-1], strict=True)]),
        np.concatenate(
            [[0], *(mesh.offsets[1:] + start for mesh, start in zip(meshes, corner_starts[:-1], strict=True))]
        ),
        sum((mesh.topology for mesh in meshes), ()),
    )


def selected_corners(mesh, order):
    """Indices of the corners of the polygons in the given order, and the new offsets."""
    sizes = np.diff(mesh.offsets)[order]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    return np.repeat(mesh.offsets[:-1][order] - offsets[:-1], sizes) + np.arange(offsets[-1]), offsets


def relabelled(mesh, seed=1):
    """Vertices and faces in random order, each face beginning at a random corner; of one component.
    Returns the mesh and the old index of each new vertex."""
    random = np.random.default_rng(seed)
    vertex_order, face_order = random.permutation(len(mesh.vertices)), random.permutation(mesh.face_count)
    new_index = np.empty_like(vertex_order)
    new_index[vertex_order] = np.arange(len(vertex_order))
    take, offsets = selected_corners(mesh, face_order)
    sizes = np.diff(offsets)
    turn = np.repeat(random.integers(0, sizes), sizes)
    start, size = np.repeat(offsets[:-1], sizes), np.repeat(sizes, sizes)
    take = take[start + (np.arange(len(take)) - start + turn) % size]
    return Mesh(mesh.vertices[vertex_order], new_index[mesh.corners[take]], offsets, mesh.topology), vertex_order


def reversed_faces(mesh, which):
    """The polygons selected by the mask `which` in reverse; each keeps its first corner."""
    sizes = np.diff(mesh.offsets)
    start, size = np.repeat(mesh.offsets[:-1], sizes), np.repeat(sizes, sizes)
    place = np.arange(len(mesh.corners)) - start
    place = np.where(np.repeat(which, sizes), (size - place) % size, place)
    return replace(mesh, corners=mesh.corners[start + place])


def partly_reversed(mesh, fraction=0.2, seed=5):
    """A random part of the polygons in reverse."""
    return reversed_faces(mesh, np.random.default_rng(seed).random(mesh.face_count) < fraction)


def triangles_of(mesh):
    """A mesh of quads cut into triangles."""
    return uniform(mesh.vertices, cut_quads(mesh.corners.reshape(-1, 4)), mesh.topology)


def mirrored(mesh):
    """The other orientation: every face reversed, nothing moved."""
    return reversed_faces(mesh, np.ones(mesh.face_count, dtype=bool))


def moved(mesh, scale=1.0, seed=3):
    """Scaled, rotated and translated."""
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    return replace(mesh, vertices=scale * (mesh.vertices @ rotation.T + [0.3, -1.7, 0.9]))


def subdivided(mesh):
    """Every triangle cut into four at the midpoints of its edges; of a mesh of triangles."""
    faces = mesh.corners.reshape(-1, 3)
    n = len(mesh.vertices)
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    key, side = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    middle = n + side.reshape(-1, 3)
    a, b, c = faces.T
    ab, bc, ca = middle.T
    cut = np.stack([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]])
    points = np.concatenate([mesh.vertices, (mesh.vertices[key // n] + mesh.vertices[key % n]) / 2])
    return uniform(points, cut.transpose(2, 0, 1).reshape(-1, 3), mesh.topology)


def single(mesh):
    """With coordinates of single precision."""
    return replace(mesh, vertices=np.float32(mesh.vertices).astype(float))


def with_slivers(mesh, count, kind="edge", seed=0):
    """The mesh with triangles without area beside polygons, on edges between two.

    kind : "edge", of two ends and a point between them; "end", where that point is one of the ends; "chain", three side
        by side; "border", on edges of one polygon, or on any where there are no such edges
    """
    random = np.random.default_rng(seed)
    points, faces = [*mesh.vertices], [f.tolist() for f in np.split(mesh.corners, mesh.offsets[1:-1])]
    sides = [(f, a, b) for f, face in enumerate(faces) for a, b in zip(face, face[1:] + face[:1])]
    known = {(a, b) for _, a, b in sides}
    border = [side for side in sides if side[:0:-1] not in known] if kind == "border" else []
    sides, is_filled = border or sides, set()
    for f, a, b in (sides[k] for k in random.permutation(len(sides))):
        if f in is_filled or len(is_filled) == count:
            continue
        is_filled.add(f)
        for _ in range(3 if kind == "chain" else 1):
            part, m = 0.0 if kind == "end" else random.uniform(0.3, 0.7), len(points)
            points.append((1 - part) * points[a] + part * points[b])
            faces.append([b, a, m] if border else [a, b, m])
            if not border:
                faces[f].insert(faces[f].index(a) + 1, m)
            a = m
    corners, offsets = np.concatenate(faces), np.cumsum([0, *map(len, faces)])
    return replace(mesh, vertices=np.array(points), corners=corners, offsets=offsets)
