"""Cones that are chosen for a tiling that turns: kept, checked, and exchanged with the holes."""

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, TopologyError, automatic_map, automatic_maps, automatic_structure
from solved import surface_of

MESHES = {
    "ball": lambda: families.geodesic_sphere(8),
    "torus": lambda: families.torus(30, 20, R=1.5),
    "bowl": lambda: families.hemisphere(8),
    "block": lambda: families.block_with_holes(2, refine=3, jitter=0.2),
}


def tile(surface, turns=4, **options):
    return automatic_structure(surface).tile(300, turns=turns, evenness=0.5, **options)


def chosen(made):
    return dict(zip(made.cones.tolist(), made.cone_angles.tolist()))


def neighbour(surface, vertex, others):
    edges = np.asarray(surface._native.edges)
    near = edges[(edges == vertex).any(axis=1)].ravel()
    return int(next(v for v in near if v != vertex and v not in others))


@pytest.mark.parametrize("turns", [2, 4, 6])
@pytest.mark.parametrize("name", MESHES)
def test_the_cones_that_are_found_give_the_same_map(name, turns):
    """On a bowl, too, whose hole has the rest; to the last bit."""
    surface = surface_of(MESHES[name]())
    made = tile(surface, turns)
    again = tile(surface, turns, cones=chosen(made))
    assert len(made.cones) and np.array_equal(again.uv, made.uv)


@pytest.mark.parametrize("turns", [2, 4])
@pytest.mark.parametrize("name", MESHES)
def test_a_cone_moves_to_another_vertex(name, turns):
    """Edges stay symmetries of the texture, and the angles are those that are chosen."""
    surface = surface_of(MESHES[name]())
    made = tile(surface, turns)
    cones = chosen(made)
    first = next(iter(cones))
    place = neighbour(surface, first, cones)
    cones[place] = cones.pop(first)
    moved = tile(surface, turns, cones=cones)
    assert chosen(moved) == {vertex: cones[vertex] for vertex in sorted(cones)}
    at = (moved.uv @ [1, 1j])[surface._native.triangle_corners]
    corners = np.angle((np.roll(at, 1, axis=1) - at) / (np.roll(at, -1, axis=1) - at))
    around = np.bincount(surface.triangles.ravel(), corners.ravel()) / (2 * np.pi)
    assert np.allclose(around[moved.cones], moved.cone_angles, atol=1e-6)
    assert moved.quality.lost_part < 0.02


def test_holes_have_what_the_cones_leave():
    """As it suits the shape: one or two cones on a bowl, none on a tube, and pairs of opposite ones."""
    bowl, tube = surface_of(families.hemisphere(8)), surface_of(families.cylinder(16, 24))
    top = int(np.argmax(bowl.vertices[:, 2]))
    for cones in ({}, {top: 0.75}, {top: 0.5}):
        made = tile(bowl, cones=cones)
        assert chosen(made) == cones and made.quality.lost_part == 0
    straight = tile(tube, cones={})
    assert not len(straight.cones) and straight.quality.size_range < 1.05
    heights = np.abs(tube.vertices[:, 2] - tube.vertices[:, 2].mean())
    ring = np.flatnonzero(heights < heights.min() + 1e-9).tolist()
    pair = {ring[0]: 0.75, ring[len(ring) // 2]: 1.25}
    assert chosen(tile(tube, cones=pair)) == pair


def test_a_sphere_of_four_cones():
    """A pillow, whose corners have half a turn."""
    ball = surface_of(families.geodesic_sphere(8))
    around = [int(np.argmax(ball.vertices @ [np.cos(a), np.sin(a), 0.0])) for a in np.pi / 2 * np.arange(4)]
    made = tile(ball, turns=2, cones=dict.fromkeys(around, 0.5))
    assert chosen(made) == dict.fromkeys(sorted(around), 0.5) and made.quality.lost_part < 0.02


@pytest.mark.parametrize(
    ("cones", "error", "words"),
    [
        ({5: 0.75}, TopologyError, "1/4 of a turn are missing in all; on this surface it must be 8/4"),
        ({}, TopologyError, "0/4 of a turn are missing in all; on this surface it must be 8/4"),
        ({5: 0.7}, ValueError, "the angle around a cone is 0.7 turns; multiples of 1/4"),
        ({5: 0.0}, ValueError, "the angle around a cone is 0.0; a positive number is needed"),
        ({5: "wide"}, ValueError, "the angle around a cone is 'wide'"),
        ({-1: 0.75}, TopologyError, "cone -1 is not a vertex"),
        ({0.5: 0.75}, InvalidMesh, "cones has the type float64; integers are needed"),
        ({5: 1e18}, ValueError, r"the angle around a cone is 1e\+18 turns; multiples of 1/4"),
        ({5: 1e300}, ValueError, r"the angle around a cone is 1e\+300 turns; multiples of 1/4"),
        ([5], ValueError, "a dictionary from vertices to angles in full turns is needed"),
    ],
)
def test_wrong_cones_are_named(cones, error, words):
    with pytest.raises(error, match=words):
        tile(surface_of(families.geodesic_sphere(4)), cones=cones)


def test_cones_on_a_boundary_or_beside_lines_are_refused():
    tube = surface_of(families.cylinder(16, 24))
    end = int(np.argmax(tube.vertices[:, 2]))
    with pytest.raises(TopologyError, match=f"vertex {end} is on the boundary, where no cone can be"):
        tile(tube, cones={end: 0.75})
    for options in ({"turns": 1}, {"turns": 4, "lines": "free"}):
        with pytest.raises(
            ValueError, match="cones can be chosen for tilings that turn by 2, 4 or 6 and have no lines"
        ):
            tile(tube, cones={40: 0.75}, **options)


def test_automatic_maps_have_them_on_their_part():
    """Vertices are those of the mesh; other parts find their own."""
    ball = surface_of(families.geodesic_sphere(8))
    count, made = len(ball.vertices), automatic_map(ball, main="seamless", turns=4)
    both = type(ball)(
        np.vstack([ball.vertices + [3, 0, 0], ball.vertices]), np.vstack([ball.triangles, ball.triangles + count])
    )
    cones = chosen(made.tiling)
    first = next(iter(cones))
    cones[neighbour(ball, first, cones)] = cones.pop(first)
    one, other = automatic_maps(
        both, main="seamless", turns=4, cones={count + vertex: angle for vertex, angle in cones.items()}
    )
    assert chosen(other.tiling) == dict(sorted(cones.items())) and chosen(one.tiling) != chosen(other.tiling)
    alone = automatic_map(ball, main="seamless", turns=4, cones=cones)
    assert alone.cones.tolist() == sorted(cones)


def test_what_chosen_cones_do_not_fit_is_refused():
    """No other map takes the place of the one that is asked for."""
    with pytest.raises(TopologyError, match="on this surface it must be"):
        automatic_map(surface_of(families.geodesic_sphere(4)), main="seamless", turns=4, cones={3: 0.75})


def test_bits_do_not_depend_on_threads():
    bowl = surface_of(families.hemisphere(8))
    top = int(np.argmax(bowl.vertices[:, 2]))
    options = {"turns": 4, "evenness": 0.5, "cones": {top: 0.75}}
    one, two = (automatic_structure(bowl, threads=n).tile(200, **options) for n in (1, 3))
    assert np.array_equal(one.uv, two.uv)
