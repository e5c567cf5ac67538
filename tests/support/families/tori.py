"""Tori: of revolution, knotted, flat; square-tiled surfaces."""

from dataclasses import replace

import numpy as np

from families.mesh import FlatSurface, components, uniform


def grid_quads(n, m):
    """Quads (n m, 4) of the n x m grid closed up in both directions; vertex (i, j) has index i m + j."""
    i, j = np.divmod(np.arange(n * m), m)
    right, up = (i + 1) % n, (j + 1) % m
    return np.stack([i * m + j, right * m + j, right * m + up, i * m + up], axis=1)


def cut_quads(quads, alternate=False):
    """Two triangles per quad; `alternate` flips the diagonal of every other quad."""
    a, b, c, d = quads.T
    flipped = (np.arange(len(quads)) % 2 == 1) & alternate
    first = np.where(flipped[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(flipped[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return np.stack([first, second], axis=1).reshape(-1, 3)


def angles(n, m):
    """Parameters (2, n m) in [0, 2 pi) of the vertices of `grid_quads(n, m)`."""
    i, j = np.divmod(np.arange(n * m), m)
    return 2 * np.pi * i / n, 2 * np.pi * j / m


def torus_points(theta, phi, R=2.0, r=1.0):
    rho = R + r * np.cos(phi)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=-1)


def torus(n, m, R=2.0, r=1.0, shape="quads", jitter=0.0, seed=0):
    """A torus of revolution, tau = i r / sqrt(R^2 - r^2); `jitter` moves vertices on it, in units of a grid step."""
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (2, n * m))
    theta, phi = angles(n, m)
    points = torus_points(theta + noise[0] * 2 * np.pi / n, phi + noise[1] * 2 * np.pi / m, R, r)
    quads = grid_quads(n, m)
    faces = {"quads": quads, "triangles": cut_quads(quads), "alternating": cut_quads(quads, alternate=True)}[shape]
    return uniform(points, faces, ((1, 0),))


def torus_knot(n, m, p=2, q=3, thickness=0.3):
    """A tube around the (p, q) torus knot; the frame is made of the tangent and the normal of the torus it winds on."""
    t = 2 * np.pi * np.arange(n) / n
    centre = torus_points(p * t, q * t, 2.0, 0.8)
    rate = 2 * np.pi / n
    tangent = (np.roll(centre, -1, axis=0) - np.roll(centre, 1, axis=0)) / (2 * rate)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    axis = np.stack([np.cos(p * t) * np.cos(q * t), np.sin(p * t) * np.cos(q * t), np.sin(q * t)], axis=1)
    side = np.cross(tangent, axis)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, tangent)
    phi = 2 * np.pi * np.arange(m) / m
    around = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * up[:, None]
    return uniform((centre[:, None] + thickness * around).reshape(-1, 3), grid_quads(n, m), ((1, 0),))


def flat_torus(tau, n, jitter=0.0, seed=0):
    """The torus C / (Z + tau Z) as 2 n^2 triangles without positions. Its modulus is tau on every such mesh: linear
    functions are represented exactly. With n = 1 both triangles have the same vertex three times."""
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (2, n, n)) / n
    i, j = np.indices((n, n))
    x, y = i / n + noise[0], j / n + noise[1]

    def vertex(di, dj):
        return ((i + di) % n) * n + (j + dj) % n

    def point(di, dj):
        wrapped = ((i + di) % n, (j + dj) % n)
        return x[wrapped] + (i + di) // n + tau * (y[wrapped] + (j + dj) // n)

    def edge(kind, di=0, dj=0):
        return kind * n * n + vertex(di, dj)

    along, across, diagonal = 0, 1, 2
    steps = [((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))]
    edges = [(edge(across, 1, 0), edge(diagonal), edge(along)), (edge(along, 0, 1), edge(across), edge(diagonal))]
    faces, lengths = [], []
    for corners in steps:
        p = [point(*corner) for corner in corners]
        faces.append(np.stack([vertex(*corner) for corner in corners], axis=-1))
        lengths.append(np.stack([abs(p[2] - p[1]), abs(p[0] - p[2]), abs(p[1] - p[0])], axis=-1))
    sides = [np.stack(triple, axis=-1) for triple in edges]
    return FlatSurface(*(np.stack(part, axis=2).reshape(-1, 3) for part in (faces, lengths, sides)), genus=1)


def square_tiled(right, up, k):
    """Unit squares glued by two permutations, `right[s]` and `up[s]`, each cut into 2 k^2 triangles."""
    right, up = np.asarray(right), np.asarray(up)
    d = len(right)
    s, i, j = np.indices((d, k, k))

    def vertex_at(s, i, j):
        """Corners on the right and upper sides belong to the neighbours; the cone points remain to be identified."""
        s, i = np.where(i == k, right[s], s), np.where(i == k, 0, i)
        s, j = np.where(j == k, up[s], s), np.where(j == k, 0, j)
        return (s * k + i) * k + j

    # Around a cone point the ways right-up and up-right end in different squares: their corners are one vertex.
    glued = components(d * k * k, up[right] * k * k, right[up] * k * k)
    _, vertex_of = np.unique(glued, return_inverse=True)

    def vertex(di, dj):
        return vertex_of[vertex_at(s, i + di, j + dj)]

    def horizontal(dj):
        top = j + dj == k
        return (np.where(top, up[s], s) * k + i) * k + np.where(top, 0, j + dj)

    def vertical(di):
        end = i + di == k
        return d * k * k + (np.where(end, right[s], s) * k + np.where(end, 0, i + di)) * k + j

    diagonal = 2 * d * k * k + (s * k + i) * k + j
    faces = [[vertex(0, 0), vertex(1, 0), vertex(1, 1)], [vertex(0, 0), vertex(1, 1), vertex(0, 1)]]
    sides = [[vertical(1), diagonal, horizontal(0)], [horizontal(1), vertical(0), diagonal]]
    faces = np.stack([np.stack(triple, axis=-1) for triple in faces], axis=3).reshape(-1, 3)
    sides = np.stack([np.stack(triple, axis=-1) for triple in sides], axis=3).reshape(-1, 3)
    lengths = np.where(sides >= 2 * d * k * k, np.sqrt(2.0), 1.0) / k
    chi = len(np.unique(vertex_of)) - 3 * d * k * k + 2 * d * k * k
    return FlatSurface(faces, lengths, sides, genus=1 - chi // 2)


def without_triangle(flat, which):
    """One triangle taken out of a `FlatSurface`; its vertices must be three."""
    keep = np.arange(len(flat.faces)) != which
    return replace(flat, faces=flat.faces[keep], edge_lengths=flat.edge_lengths[keep], face_edges=flat.face_edges[keep])
