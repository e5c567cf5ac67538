"""Turned tilings of surfaces that mirror themselves: both halves are alike, to the last bit."""

import families
import numpy as np
import pytest
from holomorph import Surface, TopologyError, automatic_map, automatic_structure
from solids import revolved
from solved import surface_of
from turned_jumps import jump_errors


def ball():
    heights = np.linspace(-np.pi / 2, np.pi / 2, 13)
    return revolved(*((max(np.cos(each), 0) * (abs(each) < 1.5), np.sin(each)) for each in heights))


def beast(tilt=0.0):
    """A ball with two horns and a nose, which mirrors itself where x changes its sign, unless it is tilted."""
    whole = ball()
    points = whole.vertices / np.linalg.norm(whole.vertices, axis=1, keepdims=True)
    tips = np.array([[0.6, 0, 0.8], [-0.6, 0, 0.8], [0, 1, 0]])
    heights = (np.maximum(points @ tips.T, 0) ** 16).sum(axis=1)
    points = points * (1 + 0.9 * heights + tilt * points[:, 0])[:, None]
    return Surface.from_polygons(points, whole.corner_vertices, whole.face_offsets)


SHAPES = {
    "beast": beast,
    "ball": ball,
    "torus": lambda: surface_of(families.torus(24, 16, R=2.0)),
    "bowl": lambda: surface_of(families.hemisphere(8)),
    "tube": lambda: surface_of(families.cylinder(16, 12)),
}


@pytest.fixture(params=SHAPES)
def surface(request):
    return SHAPES[request.param]()


def mirrored(surface, tiles=200, turns=4, **options):
    return automatic_structure(surface).tile(tiles, turns=turns, lines="mirror", evenness=0.5, **options)


def at_reflected_corners(surface, uv):
    """(#C, 2) UVs at the corner whose place, and the centre of whose polygon, mirror those of each one in x or y."""
    points = surface.vertices[surface.corner_vertices]
    sizes = np.diff(surface.face_offsets)
    centres = np.repeat(np.add.reduceat(points, surface.face_offsets[:-1]) / sizes[:, None], sizes, axis=0)
    places = np.concatenate([points, centres], axis=1)
    for axis in (0, 1):
        middle = surface.vertices[:, axis].min() + surface.vertices[:, axis].max()
        reflected = places.copy()
        reflected[:, [axis, 3 + axis]] = middle - places[:, [axis, 3 + axis]]
        distances = np.linalg.norm(places[None] - reflected[:, None], axis=2)
        if distances.min(axis=1).max() < 1e-6:
            yield uv[distances.argmin(axis=1)]


def test_the_other_half_is_the_reflected_map(surface):
    uv = mirrored(surface).uv
    assert any(np.array_equal(twins, uv * [-1, 1]) for twins in at_reflected_corners(surface, uv))


@pytest.mark.parametrize("turns", [2, 4])
def test_its_jumps_are_symmetries_of_the_texture(surface, turns):
    made = mirrored(surface, turns=turns)
    assert jump_errors(surface, made).max() == 0 and made.lines == "mirror"


def test_what_is_missing_around_its_cones_is_the_euler_number():
    for name in ("beast", "ball", "torus"):
        surface = SHAPES[name]()
        made = mirrored(surface)
        assert (4 * (1 - made.cone_angles)).sum() == 4 * surface.euler_characteristic
        assert len(set(made.cones.tolist())) == len(made.cones)


def test_a_surface_that_does_not_mirror_itself_is_refused():
    with pytest.raises(TopologyError, match="does not mirror itself"):
        mirrored(beast(tilt=0.01))


def test_bits_do_not_depend_on_threads():
    asked = {"main": "seamless", "turns": 4, "lines": "mirror"}
    made = [automatic_map(beast(), **asked, threads=count).uv for count in (1, 2, 4)]
    assert np.array_equal(made[0], made[1]) and np.array_equal(made[0], made[2])


@pytest.mark.parametrize(("tilt", "lines"), [(0.0, "mirror"), (0.01, "none")])
def test_an_automatic_map_is_mirrored_where_that_is_asked_for_and_possible(tilt, lines):
    made = automatic_map(beast(tilt), main="seamless", turns=4, lines="mirror")
    assert made.tiling.lines == lines
    assert ("both halves are alike" in made.verdict.sentence) == (lines == "mirror")
