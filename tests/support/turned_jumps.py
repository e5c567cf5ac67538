"""Jumps of tilings that turn, against their UVs."""

import numpy as np


def both_sides(surface, made):
    """(((#E, 2) complex UVs at the ends of inner edges, in the triangle on the left and on the right), (#E,) seam)."""
    native = surface._native
    ends, edges = surface.triangles, native.triangle_edges.ravel()
    uv = made.uv @ np.linalg.inv(made.lattice).T
    at = uv[native.triangle_corners]
    following = np.roll(np.arange(3), -1)
    start, end = at.reshape(-1, 2), at[:, following].reshape(-1, 2)
    is_left = ends.ravel() == native.edges[edges, 0]
    count = np.bincount(edges, minlength=len(native.edges))
    left, right = np.zeros((2, len(count), 2, 2))
    left[edges[is_left]] = np.stack([start, end], axis=1)[is_left]
    right[edges[~is_left]] = np.stack([end, start], axis=1)[~is_left]
    seam = np.full(len(count), -1)
    keys = {tuple(pair): k for k, pair in enumerate(native.edges.tolist())}
    seam[[keys[tuple(pair)] for pair in made.seams.tolist()]] = np.arange(len(made.seams))
    return left, right, seam, count == 2


def turn(turns):
    """The turn of the lattice by a part of a full one, in its own coordinates."""
    return {2: -np.eye(2), 4: np.array([[0, -1], [1, 0]]), 6: np.array([[0, -1], [1, 1]])}[turns]


def jump_errors(surface, made):
    """(#E, 2, 2): by how much the UVs on the right of inner edges are not those on the left, turned and moved."""
    turns = made.turns
    left, right, seam, is_inner = both_sides(surface, made)
    jumps = np.vstack([made.jumps, [0, 0, 0]])[seam]
    powers = np.stack([np.linalg.matrix_power(turn(turns), r) for r in range(turns)])
    expected = np.einsum("eij,ekj->eki", powers[jumps[:, 0]], left) + jumps[:, None, 1:]
    return np.abs(right - expected)[is_inner]
