"""One size of squares over all parts: which tilings have it, and what is done where none has."""

import families
import numpy as np
import pytest
from holomorph import Quality, Surface, automatic_map, automatic_maps, automatic_structure
from holomorph.maps.arrangement import arranged
from holomorph.maps.budget import Budget
from holomorph.maps.map import Map
from holomorph.maps.map_objects import map_objects
from holomorph.maps.request import Request
from holomorph.maps.size import LIKE_SIZE, TOLERANCE, SizePolicy, best_window, is_in, window_around
from holomorph.maps.tiling_search import MOST_STRETCHED, UNEVEN, TilingSearch, stretched
from holomorph.quality.distortion import drawn_densities
from solved import surface_of

LIKE = 1.1  # largest over smallest median density of parts whose squares have one size


def limb(scale=1.0, length=6.0):
    """A ball with a long limb: poles at both ends are enough for it."""
    surface = surface_of(families.geodesic_sphere(6))
    points = np.array(surface.vertices)
    is_limb = points[:, 2] > 0.3
    points[is_limb, 2] += length * (points[is_limb, 2] - 0.3)
    return Surface.from_polygons(scale * points, surface.corner_vertices, surface.face_offsets)


def test_the_window_holds_the_wanted_density_and_most_by_weight():
    assert best_window([], []) == window_around()
    sizes = [[0.93], [0.92, 1.2], [1.06], [1.5]]
    low, high = best_window(sizes, [1.0, 1.0, 1.5, 9.0])
    assert low <= 0.92 and low <= 1 <= high == pytest.approx(low * LIKE_SIZE)
    assert is_in(best_window(sizes, [1.0, 1.0, 2.5, 9.0]), 1.06)


@pytest.mark.parametrize("options", [{}, {"tiles": 150.0}, {"density": 12.0}], ids=["default", "tiles", "density"])
@pytest.mark.parametrize("main", ["automatic", "seamless"])
def test_all_parts_have_one_size(main, options):
    balls = [families.geodesic_sphere(3) for _ in range(3)]
    parts = [limb(), limb(0.5), limb(0.8)]
    parts += [Surface.from_polygons(k * b.vertices, b.corners, b.offsets) for k, b in zip((0.3, 0.6, 1.1), balls)]
    whole = surface_of(families.united(*[families.Mesh(p.vertices, p.corner_vertices, p.face_offsets) for p in parts]))
    uv = arranged(automatic_maps(whole, main=main, **options), len(whole.corner_vertices))
    found = [drawn_densities(part, uv[part.corner_index])[1] for part in whole.components]
    assert max(found) <= LIKE * min(found)


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
    found = [drawn_densities(part, uv[part.corner_index])[1] for part in whole.components]
    assert max(found) <= LIKE * min(found)


def torus(scale):
    return surface_of(families.torus(24, 12, R=scale, r=0.35 * scale))


@pytest.mark.parametrize("scale", [0.9, 0.93, 0.95])
def test_squares_of_nearly_one_size_are_preferred_to_a_seam(scale):
    """Whole tiles on this torus have densities a third apart."""
    parts = [torus(1.0), torus(scale)]
    first, second = automatic_maps(parts, density=8.77)
    missed = second.density / first.density
    assert first.kind == second.kind == "tiling" and abs(missed - 1) <= TOLERANCE and not is_in(window_around(), missed)
    assert second.cost + abs(np.log(missed)) <= automatic_map(parts[1], main="untiled").cost
    requests, size = [Request(part) for part in parts], SizePolicy.of(parts, density=first.density, tolerance=0.05)
    (((_, exact), _),) = map_objects([requests], size)
    assert not exact.is_tiled


@pytest.mark.parametrize("factor", [0.8, 1 / MOST_STRETCHED, 1.3])
@pytest.mark.parametrize("turn", [0.0, 0.3], ids=["along u", "oblique"])
def test_a_limb_is_stretched_across_its_jumps_and_shows_no_seam(factor, turn):
    made = automatic_map(limb(), main="seamless", poles=2, turn=turn, max_turn=0.05, evenness=0.0).tiling
    assert (made.residues.imag != 0).any() == (turn > 0)
    found = stretched(made, factor, "square")
    assert found.quality.median_density == pytest.approx(factor * made.quality.median_density)
    own = Quality.of(made.quality._triangulation, found.uv, 1)
    assert np.allclose(found.quality.area, own.area, rtol=1e-4) and found.quality.mean_angle == own.mean_angle
    vertices = limb().corner_vertices
    _, first, index = np.unique(vertices, return_index=True, return_inverse=True)
    is_place = ~np.isin(vertices, made.poles)
    before, after = ((uv - uv[first[index]])[is_place] for uv in (made.uv, found.uv))
    assert before.any() and np.array_equal(before, np.rint(before)) and np.array_equal(before, after)
    stretch = max(factor, 1 / factor)
    assert found.quality.mean_angle == pytest.approx(stretch, abs=0.2) and not found.quality.flipped.any()


def blob(seed):
    """A ball with bumps, of few triangles."""
    mesh = families.geodesic_sphere(5)
    waves = np.random.default_rng(seed).normal(size=(6, 3)) * 3
    bumps = 1 + 0.12 * np.sin(mesh.vertices @ waves.T).sum(axis=1)
    return surface_of(families.Mesh(mesh.vertices * bumps[:, None], mesh.corners, mesh.offsets))


@pytest.mark.parametrize("seed", range(8))
def test_more_poles_are_tried_where_the_map_is_less_even_than_foretold(seed):
    surface = blob(seed)
    structure = automatic_structure(surface)
    first = Map.of_tiling(surface, structure, structure.tile(60, direction="upright", evenness=0.5))
    stages = []

    def found(evenness):
        search = TilingSearch(surface, structure, Request(surface, main="seamless", evenness=evenness), Budget(1, 1e6))
        (made,) = search.of_density(60 / surface.area, 1, lambda _fraction, stage: stages.append(stage))
        return made

    made = found(0.5)
    if first.drawn_range <= UNEVEN:
        assert np.array_equal(made.uv, first.uv)
    else:
        assert made.cost <= first.cost
    stages.clear()
    assert found(1.0).evenness == 1.0 and "search for poles" not in stages


def test_what_jumps_both_ways_or_would_be_stretched_too_far_is_not():
    made = automatic_map(limb(), main="seamless", poles=2).tiling
    for factor in (1.01 * MOST_STRETCHED, 0.99 / MOST_STRETCHED):
        assert stretched(made, factor, "square") is None
    torus = automatic_map(surface_of(families.torus(16, 8)), main="seamless").tiling
    assert stretched(torus, 1.0, "square") is None


@pytest.mark.parametrize("size", [{}, {"tiles": 300.0}, {"density": 6.0}], ids=["default", "tiles", "density"])
def test_each_object_alone_gets_the_maps_that_it_has_beside_others(size):
    objects = [[limb(0.5), limb(0.4)], [limb()], [limb(0.8), surface_of(families.geodesic_sphere(3))], [torus(0.5)]]
    requests = [[Request(part) for part in parts] for parts in objects]
    together = map_objects(requests, SizePolicy.of([part for parts in objects for part in parts], **size))
    assert sum(made.is_tiled for found in together for made in found.maps) > 2
    for own, found in zip(requests, together):
        ((alone, _),) = map_objects([own], found.size)
        assert all(np.array_equal(one.uv, other.uv) for one, other in zip(alone, found.maps))


def test_copies_with_poles_elsewhere_are_no_copies():
    """Printed, masks of more than a thousand vertices leave values out."""
    ball = surface_of(families.geodesic_sphere(11))
    masks = np.zeros((2, len(ball.vertices)), bool)
    middle = len(ball.vertices) // 2
    masks[0, middle : middle + 40] = masks[1, middle + 100 : middle + 140] = True
    assert repr(masks[0]) == repr(masks[1])
    requests = [Request(ball, main="seamless", options={"allowed": mask}) for mask in masks]
    ((maps, _),) = map_objects([requests], SizePolicy.of([ball, ball]))
    assert all(mask[made.poles].all() for mask, made in zip(masks, maps))
