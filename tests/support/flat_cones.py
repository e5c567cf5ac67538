"""Flat surfaces with cone points of every genus, glued of squares and of regular polygons."""

from dataclasses import replace

import families
import numpy as np

FLAT = 1e-9  # of angles


def random_origami(squares, seed):
    """A connected square-tiled surface: two permutations at random, (right, up)."""
    random = np.random.default_rng(seed)
    while True:
        right, up = random.permutation(squares), random.permutation(squares)
        reached, grown = {0}, {0}
        while grown:
            grown = {int(p[s]) for s in grown for p in (right, up)} - reached
            reached |= grown
        if len(reached) == squares:
            return right, up


def origamis():
    """{name: (right, up)}: eight at random of each genus from 1 to 5."""
    found, seed = {}, 0
    count = dict.fromkeys(range(1, 6), 0)
    while min(count.values()) < 8:
        squares = 3 + seed % 9
        right, up = random_origami(squares, seed)
        seed += 1
        genus = families.square_tiled(right, up, 1).genus
        if genus in count and count[genus] < 8:
            count[genus] += 1
            found[f"genus {genus}, number {count[genus]}"] = right, up
    return found


def differential(flat, triangle_count, k):
    """(#T, 3) complex values of dz along the sides of `families.square_tiled(., ., k)`, side i opposite corner i."""
    lower, upper = np.array([1j, -1 - 1j, 1]), np.array([-1, -1j, 1 + 1j])
    return np.stack([lower, upper] * (triangle_count // 2)) / k


def regular_polygon(n):
    """The regular n-gon of circumradius 1, n even, opposite sides glued: y^2 = x^(n/2) - 1 where n / 2 is odd. One
    triangle for each side."""
    i = np.arange(n)
    side = 2 * np.sin(np.pi / n)
    corners = i % 2 if n % 4 == 2 else np.zeros(n, int)
    centre = corners.max() + 1
    faces = np.stack([np.full(n, centre), corners, np.roll(corners, -1)], axis=1)
    rim, spoke = i % (n // 2), n // 2 + i
    face_edges = np.stack([rim, np.roll(spoke, -1), spoke], axis=1)
    chi = centre + 1 - (n // 2 + n) + n
    lengths = np.tile([side, 1.0, 1.0], (n, 1))
    return families.FlatSurface(faces, lengths, face_edges, genus=1 - chi // 2)


def double_polygon(n):
    """Two regular n-gons, n odd, one turned by half a turn, parallel sides glued: y^2 = x^n - 1. Both are cut from one
    corner, into n - 2 triangles with angles down to pi / n."""
    k = np.arange(1, n - 1)
    chord = 2 * np.sin(np.pi * np.arange(n) / n)
    lengths = np.stack([np.full(n - 2, chord[1]), chord[k + 1], chord[k]], axis=1)
    # Side i is from corner i to i + 1; the diagonal from corner 0 to corner j, which is a side for j = 1 and n - 1.
    names = [np.stack([k, diagonal[k + 1], diagonal[k]], axis=1) for diagonal in (_diagonals(n, 0), _diagonals(n, 1))]
    faces = np.zeros((2 * (n - 2), 3), int)
    return families.FlatSurface(faces, np.tile(lengths, (2, 1)), np.concatenate(names), genus=(n - 1) // 2)


def _diagonals(n, copy):
    names = n + copy * n + np.arange(n)
    names[[1, n - 1]] = 0, n - 1
    return names


def by_edge_lengths(faces, edge_lengths):
    """`FlatSurface` whose edges are told by their ends; entry i of a row belongs to the side opposite corner i."""
    ends = np.sort(np.stack([np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1)], axis=2), axis=2)
    names = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)[1].reshape(-1, 3)
    chi = len(np.unique(faces)) - len(faces) // 2
    return families.FlatSurface(faces, edge_lengths, names, genus=1 - chi // 2)


def jittered(flat, seed, amount=0.3):
    """The same metric with flat vertices moved, no two of them neighbours, by up to `amount` of their shortest edge."""
    faces, names = flat.faces, np.roll(flat.face_edges, 1, axis=1)  # side i from corner i to corner i + 1
    sides = np.roll(flat.edge_lengths, 1, axis=1)
    before, opposite = np.roll(sides, 1, axis=1), np.roll(sides, -1, axis=1)
    angles = np.arccos((sides**2 + before**2 - opposite**2) / (2 * sides * before))
    count = faces.max() + 1
    total, shortest = np.bincount(faces.ravel(), angles.ravel()), np.full(count, np.inf)
    np.minimum.at(shortest, faces, np.minimum(sides, before))

    random = np.random.default_rng(seed)
    priority = np.where(np.abs(total - 2 * np.pi) < FLAT, random.random(count), -1)
    highest = np.full(count, -1.0)
    for k in (1, 2):
        np.maximum.at(highest, faces, np.roll(priority[faces], k, axis=1))
    step = amount * shortest * random.random(count) * np.exp(2j * np.pi * random.random(count))

    # Around each vertex at once, from one corner to the next over the side that arrives there.
    both = np.argsort(names.ravel(), kind="stable").reshape(-1, 2).sum(axis=1)  # corners that edges leave
    lengths = sides[np.unravel_index(np.unique(names, return_index=True)[1], names.shape)]
    corner = np.unique(faces, return_index=True)[1][priority > highest]
    direction = np.zeros(len(corner))
    for _ in range(np.bincount(faces.ravel()).max()):
        t, i = np.divmod(corner, 3)
        lengths[names[t, i]] = np.abs(sides[t, i] * np.exp(1j * direction) - step[faces[t, i]])
        direction += angles[t, i]
        corner = both[names[t, i - 1]] - (3 * t + (i - 1) % 3)
    return replace(flat, edge_lengths=lengths[flat.face_edges])
