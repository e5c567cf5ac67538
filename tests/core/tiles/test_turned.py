"""Places and lines of tilings that turn: on a cube and on a pillow, whose tiles can be counted, and on what is made."""

import pickle

import families
import numpy as np
import pytest
from holomorph import TiledSurface, TopologyError, automatic_map
from solved import surface_of
from turned_surfaces import MADE, SHAPES, angles, box, signed_area, tiled


@pytest.fixture(scope="module", params=[("ball", 2), ("ball", 4), ("ball", 6), ("torus", 2), ("torus", 4)])
def made(request):
    name, turns = request.param
    return automatic_map(surface_of(MADE[name]), main="seamless", turns=turns)


@pytest.mark.parametrize("per_tile", [1, 3])
@pytest.mark.parametrize("tiles", [2, 3])
@pytest.mark.parametrize("shape", SHAPES)
def test_each_place_is_there_once(shape, tiles, per_tile):
    """Middles as many as tiles; corners by Euler's formula as many as the vertices of a closed surface of quads."""
    count = SHAPES[shape][1] * (tiles * per_tile) ** 2
    on = tiled(shape, tiles)
    for offset, expected in (((0.5, 0.5), count), ((0, 0), count + 2)):
        found = on.places((per_tile, per_tile), offset)
        assert len(found) == expected and found.flipped == 0
        places = np.unique(np.round(found.positions, 6), axis=0)
        assert shape == "pillow" or len(places) == expected  # whose two sides are one at its corners


@pytest.mark.parametrize("tiles", [2, 3])
@pytest.mark.parametrize("shape", SHAPES)
def test_lines_go_around(shape, tiles):
    """Each is a plane cut of the box: as many as tiles across, for each pair of its sides."""
    on = tiled(shape, tiles, 0.5)
    along, across = on.lines("u"), on.lines("v")
    count = 3 * tiles if shape == "cube" else tiles
    for lines in (along, across):
        assert len(lines) == count and lines.is_closed.all()
        for first, end in zip(lines.offsets[:-1], lines.offsets[1:]):
            points = lines.positions[first:end]
            axis = np.argmin(np.ptp(points, axis=0)[:3] + (0 if shape == "cube" else np.array([0, 0, 9])))
            assert np.ptp(points[:, axis]) < 1e-9
            around = np.roll(points, -1, axis=0) - points
            assert np.linalg.norm(around, axis=1).sum() == pytest.approx(4 if shape == "cube" else 2, abs=0.02)


@pytest.mark.parametrize("per_tile", [1, 4])
@pytest.mark.parametrize("offset", [(0, 0), (0.5, 0.5)])
def test_places_are_the_area_but_at_cones(made, offset, per_tile):
    """A place at a cone has that part of a turn around it: there are more places than area by what is missing."""
    if made.turns == 6 and offset != (0, 0):
        with pytest.raises(ValueError, match="places in a tiling that turns must stay where they are"):
            made.tiled.places((per_tile, per_tile), offset)
        return
    on = made.tiled
    found = on.places((per_tile, per_tile), offset)
    corner = np.zeros(len(on.surface.vertices), np.int64)
    corner[on.surface.triangles] = on.surface.triangle_corners
    inside = np.linalg.solve(on.lattice, on.uv[corner].T).T * per_tile - offset
    is_place = np.abs(inside - np.rint(inside)).max(axis=1) < 1e-6
    missing = (1 - angles(on))[is_place].sum()
    assert len(found) - found.flipped == pytest.approx(signed_area(on) * per_tile**2 + missing)


@pytest.mark.parametrize("direction", ["u", "v", (1, 1)])
def test_lines_end_at_cones_alone(made, direction):
    on = made.tiled
    lines = on.lines(direction, 2)
    ends = np.concatenate([lines.offsets[:-1], lines.offsets[1:] - 1])[np.tile(~lines.is_closed, 2)]
    is_at_vertex = lines.barycentric[ends].max(axis=1) == 1
    vertices = on.surface.triangles[lines.triangles[ends], np.argmax(lines.barycentric[ends], axis=1)]
    assert is_at_vertex.all() and (np.abs(angles(on)[vertices] - 1) > 0.1).all()


def test_points_of_a_line_follow_each_other(made):
    """From one to the next it stays in a triangle: none is farther than the longest edge."""
    on = made.tiled
    lines, longest = on.lines("u", 3), on.surface._native.edge_lengths.max()
    steps = np.linalg.norm(np.diff(lines.positions, axis=0), axis=1)
    assert np.delete(steps, lines.offsets[1:-1] - 1).max() <= longest
    closing = lines.positions[lines.offsets[1:] - 1] - lines.positions[lines.offsets[:-1]]
    assert np.linalg.norm(closing[lines.is_closed], axis=1).max() <= longest


@pytest.mark.parametrize(
    ("turns", "options"),
    [
        (2, {"offset": (0.3, 0.5)}),
        (2, {"shifted_rows": True, "per_tile": (2, 2)}),
        (4, {"per_tile": (2, 3)}),
        (4, {"offset": (0.5, 0)}),
        (4, {"shifted_rows": True, "per_tile": (2, 2), "offset": (0, 0)}),
    ],
)
def test_places_that_turns_do_not_leave_are_refused(turns, options):
    on = tiled("cube" if turns == 4 else "pillow", 2)
    with pytest.raises(ValueError, match="places in a tiling that turns must stay where they are: "):
        on.places(**options)


def test_they_survive_a_pickle(made):
    again = pickle.loads(pickle.dumps(made.tiled))
    assert np.array_equal(again.places(offset=(0, 0)).positions, made.tiled.places(offset=(0, 0)).positions)


def test_shifted_rows_that_half_turns_leave():
    found = tiled("pillow", 2).places((2, 2), (0.25, 0.5), True)
    assert len(found) == 2 * 4 * 4


def test_what_sixth_turns_do_not_leave():
    made = automatic_map(surface_of(families.geodesic_sphere(6)), main="seamless", turns=6)
    for thing, make in (("cells", made.tiled.cells), ("a relief", lambda: made.tiled.relief(np.eye(4), 0.01))):
        with pytest.raises(TopologyError, match=f"{thing} cannot be made where tiles turn by sixths"):
            make()


def test_wrong_turns():
    surface, uv = box("cube", 2, 0.0)
    for turns in (3, "4", None):
        with pytest.raises(ValueError, match=r"turns is .*; one of 1, 2, 4, 6 is needed"):
            TiledSurface(surface, uv, turns=turns)
    with pytest.raises(TopologyError):
        TiledSurface(surface, uv)  # it turns
    with pytest.raises(TopologyError):
        TiledSurface(surface, uv, turns=2)  # by quarters
    with pytest.raises(
        TopologyError, match=r"jump by parts of a tile across the edge from vertex \d+ to \d+, where they turn"
    ):
        TiledSurface(surface, uv + (0.25, 0.0), turns=4)
