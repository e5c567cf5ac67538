"""Turned tilings whose rows run along hard edges and smooth boundaries, and end there."""

import families
import numpy as np
import pytest
from holomorph import Surface, _native, automatic_map, automatic_structure
from solids import revolved

AROUND = 32  # edges of a circle

SHAPES = {
    "can": lambda: revolved((0, 0), (0.5, 0), (0.5, 1.2), (0, 1.2)),
    "cup": lambda: revolved((0, 0), (0.5, 0), (0.5, 1), (0.42, 1), (0.42, 0.08), (0, 0.08)),
    "tube": lambda: revolved((0.5, 0), (0.5, 1.2)),
    "bowl": lambda: revolved((0, 0), (0.2, 0.02), (0.4, 0.08), (0.6, 0.3), (0.7, 0.6)),
    "box": lambda: cuboid(6),
}
LOOPS = {"can": 2, "cup": 4, "tube": 2, "bowl": 1}  # of AROUND edges each


def cuboid(n):
    number, faces = {}, []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        place = [0, 0, 0]
                        place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = side, i + a, j + b
                        corners.append(number.setdefault(tuple(place), len(number)))
                    faces.append(corners if side else corners[::-1])
    return Surface(np.array(list(number), float) * [0.2, 0.3, 0.15], faces)


def sheet_faces():
    return [[i + 21 * j, i + 1 + 21 * j, i + 22 + 21 * j, i + 21 + 21 * j] for j in range(20) for i in range(20)]


@pytest.fixture(scope="module", params=SHAPES)
def shape(request):
    return request.param, SHAPES[request.param]()


def tiling(surface, lines, turns=4, tiles=300.0, evenness=0.5):
    return automatic_structure(surface).tile(tiles, turns=turns, lines=lines, evenness=evenness)


def lines_of(surface):
    return _native.found_lines(surface._native, np.empty((0, 2), np.int32))


def along_lines(surface, made):
    """(#sides, 2, 2) UVs in lattice coordinates at the ends of the triangles' sides that are lines."""
    native = surface._native
    edges, corners = native.triangle_edges, native.triangle_corners
    sides = np.argwhere(np.isin(edges, lines_of(surface)))
    ends = np.stack([corners[sides[:, 0], sides[:, 1]], corners[sides[:, 0], (sides[:, 1] + 1) % 3]], axis=1)
    return made.uv[ends]


def test_lines_are_hard_edges_and_smooth_boundaries(shape):
    name, surface = shape
    if name in LOOPS:
        heights = surface.vertices[surface._native.edges[lines_of(surface)]][..., 2]
        np.testing.assert_allclose(heights[:, 0], heights[:, 1], atol=1e-12)
        assert len(lines_of(surface)) == LOOPS[name] * AROUND
    else:
        assert len(lines_of(surface)) == 12 * 6


def test_short_chains_and_jagged_boundaries_are_no_lines():
    ball = families.geodesic_sphere(8)
    assert not len(lines_of(Surface(ball.vertices, ball.faces)))
    grid = sheet_faces()
    points = np.array([[i, j, 0.0] for j in range(21) for i in range(21)])
    whole = Surface(points, grid)
    assert len(lines_of(whole)) == 80
    jagged = [face for face in grid if 0 < face[0] % 21 < 19 or face[0] // 21 % 2]  # teeth at two ends
    used = np.unique(jagged)
    assert not len(lines_of(Surface(points[used], np.searchsorted(used, jagged))))


def test_chains_that_end_are_no_lines():
    """A sheet with two ridges that lead nowhere; and one whose ridges cross it."""
    for first, last, lines in ((3, 17, 0), (0, 20, 80 + 2 * 20)):
        x, y = (axis.ravel() for axis in np.meshgrid(np.arange(21), np.arange(21)))
        is_raised = np.isin(x, (6, 14)) & (y >= first) & (y <= last)
        sheet = Surface(np.column_stack([x, y, 0.8 * is_raised]), sheet_faces())
        assert len(lines_of(sheet)) == lines


@pytest.mark.parametrize("lines", ["free", "whole"])
@pytest.mark.parametrize("evenness", [0.0, 0.5])
def test_lines_are_straight_to_the_last_bit(shape, lines, evenness):
    surface = shape[1]
    ends = along_lines(surface, tiling(surface, lines, evenness=evenness))
    assert (ends[:, 0] == ends[:, 1]).any(axis=1).all()
    assert (np.abs(ends[:, 0] - ends[:, 1]).max(axis=1) > 0).mean() > 0.9  # and not points


def test_rows_end_at_whole_lines(shape):
    surface = shape[1]
    ends = along_lines(surface, tiling(surface, "whole"))
    is_whole = (ends[:, 0] == ends[:, 1]) & (ends[:, 0] == np.rint(ends[:, 0]))
    assert is_whole.any(axis=1).all()


def test_squares_are_even_and_none_is_flipped(shape):
    name, surface = shape
    for lines in ("free", "whole") if name != "cup" else ("free",):  # its rim is half a tile wide
        quality = tiling(surface, lines).quality
        assert quality.lost_part == 0
        assert quality.density_ratio < 1.8
        assert quality.mean_angle < 1.15


def test_a_box_has_its_corners_for_cones():
    made = tiling(SHAPES["box"](), "whole")
    np.testing.assert_array_equal(made.cone_angles, 0.75 * np.ones(8))
    np.testing.assert_allclose(np.abs(SHAPES["box"]().vertices[made.cones] - [0.6, 0.9, 0.45]), [[0.6, 0.9, 0.45]] * 8)


def test_a_cup_has_no_more_cones_than_its_caps_ask_for():
    """Four on each; pairs of opposite ones would turn the field of its walls away from the rims."""
    cup = ((0, 0), (0.5, 0), (0.5, 1.2), (0.44, 1.2), (0.44, 0.06), (0, 0.06))
    made = tiling(revolved(*cup, sides=48, step=0.06), "free", tiles=400)
    np.testing.assert_array_equal(made.cone_angles, 0.75 * np.ones(8))


@pytest.mark.parametrize("lines", ["free", "whole"])
def test_half_turns_keep_the_lines_of_a_can(lines):
    surface = SHAPES["can"]()
    made = tiling(surface, lines, turns=2)
    ends = along_lines(surface, made)
    assert (ends[:, 0] == ends[:, 1]).any(axis=1).all()
    assert made.quality.lost_part == 0


def test_jumps_are_symmetries_of_the_texture(shape):
    surface = shape[1]
    made = tiling(surface, "free")
    native = surface._native
    ends, edges = surface.triangles, native.triangle_edges.ravel()
    following = np.roll(ends, -1, axis=1)
    uv = np.stack([made.uv[native.triangle_corners], made.uv[np.roll(native.triangle_corners, -1, axis=1)]], axis=2)
    is_left = (ends < following).ravel()
    uv[ends > following] = uv[ends > following][:, ::-1]
    at = np.full((2, len(native.edges), 2, 2), np.nan)
    for side in (0, 1):
        chosen = is_left == (side == 0)
        at[side, edges[chosen]] = uv.reshape(-1, 2, 2)[chosen]
    is_inner = np.isfinite(at).all(axis=(0, 2, 3))
    name = {tuple(ends): e for e, ends in enumerate(native.edges.tolist())}
    turn, by = np.zeros(len(native.edges), int), np.zeros((len(native.edges), 1, 2))
    seams = [name[tuple(ends)] for ends in made.seams.tolist()]
    turn[seams], by[seams, 0] = made.jumps[:, 0], made.jumps[:, 1:]
    quarters = np.stack([np.linalg.matrix_power([[0, -1], [1, 0]], r) for r in range(4)])
    moved = np.einsum("eij,enj->eni", quarters[turn], at[0]) + by
    np.testing.assert_array_equal(moved[is_inner], at[1][is_inner])


def test_bits_do_not_depend_on_threads():
    surface = SHAPES["cup"]()
    one, two = (automatic_structure(surface, threads=n).tile(300, turns=4, lines="free", evenness=0.5) for n in (1, 3))
    np.testing.assert_array_equal(one.uv, two.uv)


def test_an_automatic_map_takes_lines_where_they_cost_little():
    for name in ("box", "tube"):
        assert automatic_map(SHAPES[name](), main="seamless", turns=4).tiling.lines == "whole"
    assert automatic_map(SHAPES["cup"](), main="seamless", turns=4).tiling.lines == "free"
    ball = families.geodesic_sphere(8)
    assert automatic_map(Surface(ball.vertices, ball.faces), main="seamless", turns=4).tiling.lines == "none"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"turns": 4, "lines": "all"}, "lines is 'all'; one of none, whole, free, mirror is needed"),
        ({"turns": 4, "lines": None}, "lines is None; one of none, whole, free, mirror is needed"),
        ({"turns": 6, "lines": "free"}, "lines is 'free', for which turns must be 2 or 4"),
        ({"lines": "whole"}, "lines is 'whole', for which turns must be 2 or 4"),
    ],
)
def test_wrong_choices_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        automatic_structure(SHAPES["tube"]()).tile(100, **options)
