"""One size of squares over all parts: which tilings have it, and what is done where none has."""

import families
import numpy as np
import pytest
from holomorph import Surface, _native, automatic_map, automatic_maps
from holomorph.maps.arrangement import arranged
from holomorph.maps.map import map_objects
from holomorph.quality.distortion import drawn_density
from holomorph.tiling.request import TOLERANCE, Request, plain_size
from solved import surface_of

LIKE = 1.1  # largest over smallest median density of parts whose squares have one size


def limb(scale=1.0, length=6.0):
    """A ball with a long limb: poles at both ends are enough for it."""
    surface = surface_of(families.geodesic_sphere(6))
    points = np.array(surface.vertices)
    is_limb = points[:, 2] > 0.3
    points[is_limb, 2] += length * (points[is_limb, 2] - 0.3)
    return Surface.from_polygons(scale * points, surface.corner_vertices, surface.face_offsets)


@pytest.mark.parametrize("options", [{}, {"tiles": 150.0}, {"density": 12.0}], ids=["default", "tiles", "density"])
@pytest.mark.parametrize("main", ["automatic", "seamless"])
def test_all_parts_have_one_size(main, options):
    balls = [families.geodesic_sphere(3) for _ in range(3)]
    parts = [limb(), limb(0.5), limb(0.8)]
    parts += [Surface.from_polygons(k * b.vertices, b.corners, b.offsets) for k, b in zip((0.3, 0.6, 1.1), balls)]
    whole = surface_of(families.united(*[families.Mesh(p.vertices, p.corner_vertices, p.face_offsets) for p in parts]))
    made = automatic_maps(whole, main=main, **options)
    uv = arranged(made, len(whole.corner_vertices))
    found = np.array([drawn_density(part, uv[part.corner_index]) for part in whole.components])
    assert np.abs(found / found[0] - 1).max() <= TOLERANCE
    beyond = np.flatnonzero((found > LIKE * found[0]) | (found[0] > LIKE * found))
    assert len(beyond) <= 1
    for part in beyond:  # where whole tiles come no nearer, and another map costs more
        assert automatic_map(made[part].surface, main="untiled").cost > made[part].cost


@pytest.mark.parametrize("seed", range(3))
def test_parts_have_one_size_in_the_triangles_that_are_drawn(seed):
    """Quads are drawn as triangles from their first corners, whatever diagonals are better for solving."""
    random, parts = np.random.default_rng(seed), []
    for k in range(5):
        large, small = random.uniform(0.6, 1.2), random.uniform(0.2, 0.5)
        parts.append(families.torus(*random.integers(5, 12, 2), R=large, r=small, jitter=0.3, seed=k))
        parts[-1].vertices[:] += (4 * k, 0, 0)
    whole = surface_of(families.united(*parts))
    maps = automatic_maps(whole, main="seamless", tiles=1000)
    uv = arranged(maps, len(whole.corner_vertices))
    found = [drawn_density(part, uv[part.corner_index]) for part in whole.components]
    assert max(found) <= LIKE * min(found)


def torus(scale):
    return surface_of(families.torus(24, 12, R=scale, r=0.35 * scale))


@pytest.mark.parametrize("scale", [0.9, 0.93, 0.95])
def test_squares_of_nearly_one_size_are_preferred_to_a_seam(scale):
    """Whole tiles on this torus have densities a third apart."""
    parts = [torus(1.0), torus(scale)]
    first, second = automatic_maps(parts, density=8.77)
    missed = second.density / first.density
    assert first.kind == second.kind == "tiling" and 0.05 < abs(missed - 1) <= TOLERANCE
    assert second.cost + abs(np.log(missed)) <= automatic_map(parts[1], main="untiled").cost
    asked, size = [(Request(), part, None) for part in parts], _native.SizePolicy.of_density(first.density, 0.05)
    (((_, exact), _),) = map_objects([asked], plain_size(size))
    assert not exact.is_tiled


@pytest.mark.parametrize("size", [{}, {"tiles": 300.0}, {"density": 6.0}], ids=["default", "tiles", "density"])
def test_each_object_alone_gets_the_maps_that_it_has_beside_others(size):
    objects = [[limb(0.5), limb(0.4)], [limb()], [limb(0.8), surface_of(families.geodesic_sphere(3))], [torus(0.5)]]
    asked = [[(Request(), part, None) for part in parts] for parts in objects]
    together = map_objects(asked, Request(**size).size_of([part for parts in objects for part in parts]))
    assert sum(made.is_tiled for found in together for made in found.maps) > 2
    for own, found in zip(asked, together):
        ((alone, _),) = map_objects([own], found.size)
        assert all(np.array_equal(one.uv, other.uv) for one, other in zip(alone, found.maps))


def test_copies_with_poles_elsewhere_are_no_copies():
    """Printed, masks of more than a thousand vertices leave values out."""
    ball = surface_of(families.geodesic_sphere(11))
    masks = np.zeros((2, len(ball.vertices)), bool)
    middle = len(ball.vertices) // 2
    masks[0, middle : middle + 40] = masks[1, middle + 100 : middle + 140] = True
    assert repr(masks[0]) == repr(masks[1])
    asked = [(Request(main="seamless", allowed=mask), ball, None) for mask in masks]
    ((maps, _),) = map_objects([asked], Request().size_of([ball, ball]))
    assert all(mask[made.poles].all() for mask, made in zip(masks, maps))
