"""Lines of a tiling: as long as the area asks for, and joined wherever they go on."""

import numpy as np
import pytest
from holomorph import TiledSurface
from tiled_families import CASES, MORE, tiled
from tiled_grids import flat_square, folded_torus, grid_torus

EXACT = 1e-9
DIRECTIONS = {"u": (1, 0), "v": (0, 1), (1, 1): (1, 1), (-2, 3): (-2, 3)}
everywhere = pytest.mark.parametrize("name", CASES | MORE)
directions = pytest.mark.parametrize("direction", DIRECTIONS)


def levels(on, direction, per_tile=1):
    """(#T, 3) of the triangles' corners: whole numbers on the lines."""
    a, b = DIRECTIONS[direction]
    x, y = np.linalg.solve(on.lattice, on.uv.T)
    return (per_tile * (b * x - a * y))[on.surface.triangle_corners]


def cut_length(on, level):
    """Length of what whole numbers of `level` cut out of the triangles that touch no pole."""
    kept = ~np.isin(on.surface.triangles, on.poles).any(axis=1)
    level, corners, total = level[kept], on.surface.vertices[on.surface.triangles[kept]], 0.0
    for line in range(int(np.ceil(level.min())), int(np.floor(level.max())) + 1):
        found = np.zeros(len(level), int)
        points = np.zeros((len(level), 2, 3))
        for i in range(3):
            a, b = level[:, i], level[:, (i + 1) % 3]
            crosses = (a <= line) != (b <= line)
            t = ((line - a[crosses]) / (b - a)[crosses])[:, None]
            points[crosses, found[crosses]] = (1 - t) * corners[crosses, i] + t * corners[crosses, (i + 1) % 3]
            found += crosses
        total += np.linalg.norm(points[:, 0] - points[:, 1], axis=1).sum()
    return total


def boundary_length(on, level):
    """Length of the boundary's sides along whole numbers."""
    native = on.surface._native
    is_border = np.bincount(native.triangle_edges.ravel())[native.triangle_edges] == 1
    is_on = is_border & (level == np.roll(level, -1, axis=1)) & (np.abs(level - np.rint(level)) < EXACT)
    return native.edge_lengths[native.triangle_edges[is_on]].sum()


def segments(lines):
    """(n, 2) points of each segment."""
    sizes = np.diff(lines.offsets)
    following = np.arange(1, len(lines.triangles) + 1)
    following[lines.offsets[1:] - 1] = lines.offsets[:-1]
    both = np.stack([np.arange(len(following)), following], axis=1)
    is_last = np.zeros(len(following), bool)
    is_last[lines.offsets[1:] - 1] = ~lines.is_closed
    assert (sizes >= 2).all()
    return both[~is_last]


@everywhere
@directions
def test_they_are_what_the_triangles_are_cut_along(name, direction):
    on = tiled(name)
    for per_tile in (1, 2):
        lines = on.lines(direction, per_tile)
        a, b = lines.positions[segments(lines)].swapaxes(0, 1)
        length = np.linalg.norm(a - b, axis=1).sum()
        level, little = levels(on, direction, per_tile), 1e-7  # to one side or the other of lines along the boundary
        expected = (cut_length(on, level + little) + cut_length(on, level - little) + boundary_length(on, level)) / 2
        assert abs(length - expected) < 1e-5 * length
        level = np.einsum("ni,ni->n", lines.barycentric, levels(on, direction, per_tile)[lines.triangles])
        kept = ~np.isin(on.surface.triangles[lines.triangles], on.poles).any(axis=1)
        assert np.abs(level - np.rint(level))[kept].max() < EXACT


@everywhere
@directions
def test_no_point_is_on_two_and_closed_surfaces_have_closed_ones(name, direction):
    on = tiled(name)
    lines = on.lines(direction)
    start_end = np.concatenate([lines.offsets[:-1], lines.offsets[1:] - 1])
    inner = np.setdiff1d(np.arange(len(lines.triangles)), start_end)
    assert len(np.unique(lines.positions[inner].round(9), axis=0)) == len(inner)
    if not len(on.poles) and not on.surface.boundary_count:
        assert lines.is_closed.all()
    assert len(lines) == len(lines.is_closed)


@pytest.mark.parametrize(("columns", "rows"), [(7, 5), (1, 3), (4, 6)])
@pytest.mark.parametrize("shift", [0.1, 0])
def test_on_a_torus_they_are_as_many_as_rows_and_columns(columns, rows, shift):
    """With shift 0 and no jitter some run along edges."""
    on = grid_torus(12, 9, columns, rows, shift, jitter=0.3 if shift else 0)
    for direction, count in (("u", rows), ("v", columns), ((1, 1), np.gcd(columns, rows))):
        lines = on.lines(direction)
        assert lines.is_closed.all() and len(lines) == count


def test_they_run_in_their_direction():
    surface, uv = flat_square((0.5, 0.5))
    for direction, along in ((("u"), (1, 0)), ("v", (0, 1)), ((1, 1), (1, 1)), ((-1, 2), (-1, 2)), ((-1, 0), (-1, 0))):
        lines = TiledSurface(surface, uv).lines(direction)
        a, b = lines.positions[segments(lines)].swapaxes(0, 1)
        assert ((b - a)[:, :2] @ along > 0).all()
        assert not lines.is_closed.any()
    assert len(TiledSurface(surface, uv).lines()) == 4
    assert len(TiledSurface(surface, uv).lines(per_tile=3)) == 12


@pytest.mark.parametrize("seed", range(5))
def test_whatever_folds_they_close(seed):
    """But where an edge lies on one and the map turns back there."""
    lines = folded_torus(seed, on_lines=0).lines()
    assert lines.is_closed.all() and len(lines.triangles) > 50
    on_edges = folded_torus(seed).lines()
    assert len(np.unique(on_edges.positions.round(9), axis=0)) > 50


def test_no_thread_changes_a_bit():
    on = tiled("genus 5")
    one, two = (TiledSurface(on.surface, on.uv, on.lattice, threads=n).lines() for n in (1, 2))
    for attribute in ("offsets", "is_closed", "triangles", "barycentric"):
        assert (getattr(one, attribute) == getattr(two, attribute)).all()


@pytest.mark.parametrize("direction", ["w", (2, 4), (0, 0), (1.5, 1), (1,), None, (10**7, 1), (True, "u")])
def test_other_directions_are_refused(direction):
    with pytest.raises(ValueError, match="direction is .* whole numbers without a common divisor"):
        tiled("torus").lines(direction)


def test_other_counts_are_refused():
    with pytest.raises(ValueError, match="per_tile has 0"):
        tiled("torus").lines(per_tile=0)
