"""Flat surfaces with cone points of every genus, glued of squares and of regular polygons."""

import families
import numpy as np


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
