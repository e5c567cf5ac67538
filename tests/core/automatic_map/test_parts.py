"""Parts of a mesh: copies are mapped once."""

from dataclasses import replace

import families
import holomorph
import numpy as np
import pytest
from holomorph import Surface, _native, automatic_maps
from holomorph.tiling.request import part_of
from solved import surface_of


def copies(parts):
    """(index of the part that stands for it, lengths over those of that one) of each part."""
    return _native.copies([part_of(part) for part in parts], None)


def moved(surface, angle=0.0, scale=1.0, shift=(0.0, 0.0, 0.0), axis=2):
    """Turned about an axis, scaled and moved."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.roll(np.roll([[c, -s, 0], [s, c, 0], [0, 0, 1]], axis - 2, axis=0), axis - 2, axis=1)
    points = (scale * surface.vertices @ np.transpose(turn) + shift).astype(np.float32)
    return Surface.from_polygons(points, surface.corner_vertices, surface.face_offsets)


def test_copies_are_moved_turned_about_the_vertical_and_scaled():
    first = surface_of(families.torus(12, 8, shape="triangles"))
    parts = [first, moved(first, 0.7, 1.0, (3, 4, 5)), moved(first, 0.2, 2.5), moved(first, 0.5, axis=0)]
    parts.append(moved(surface_of(families.torus(12, 8, R=2.1, shape="triangles"))))
    found = copies(parts)
    assert [index for index, _ in found] == [0, 0, 0, 3, 4]
    assert found[2][1] == pytest.approx(2.5, rel=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_copies_far_away_are_those_that_single_precision_makes(seed):
    """Each coordinate is rounded by half a unit in the last place of single precision, a length by that of three
    differences. What is moved by four times as much is no copy."""
    first = surface_of(families.torus(12, 8, shape="triangles"))
    shift = np.random.default_rng(seed).uniform(900, 1000, 3)
    far = moved(first, shift=shift)
    vertices = np.array(far.vertices)
    longest = 2 * 3**0.5 * np.spacing(np.float32(np.abs(vertices).max())) / 2
    assert np.abs(far._native.edge_lengths - first._native.edge_lengths).max() > longest / 10
    assert [index for index, _ in copies([first, far])] == [0, 0]
    vertices[40, 2] += 4 * longest
    other = Surface.from_polygons(vertices, first.corner_vertices, first.face_offsets)
    assert [index for index, _ in copies([first, other])] == [0, 1]


@pytest.mark.parametrize("scale", [1.0, 0.37])
def test_polygons_with_corners_on_a_circle_are_cut_alike_in_all_copies(scale):
    """Both diagonals are as good, and rounding would choose another one in each copy."""
    first = surface_of(families.torus(24, 12))
    parts = [first, *(moved(first, angle, scale, (3, 4, 5)) for angle in (0.1, 0.7, 2.0))]
    assert all(np.array_equal(part.triangles, first.triangles) for part in parts)
    assert [index for index, _ in copies(parts)] == [0] * 4


def test_the_map_of_a_copy_is_that_of_its_part():
    first = surface_of(families.torus(24, 12, shape="triangles"))
    parts = [first, moved(first, 0.7, 1.0, (30, 4, 5)), moved(first, 0.2, 2.0, (0, 30, 0))]
    made = automatic_maps(parts, tiles=900)
    assert [found.kind for found in made] == ["tiling"] * 3
    assert np.array_equal(made[0].uv, made[1].uv)
    for part, found in zip(parts, made):
        own = holomorph.Quality.of(part._native, found.uv, 1)
        assert found.surface is part and found.quality.median_density == pytest.approx(own.median_density, rel=1e-5)
    densities = [found.density for found in made]
    assert max(densities) < 1.2 * min(densities)


def test_copies_are_maps_of_their_own_where_u_runs_along_a_vector():
    first = surface_of(families.torus(24, 12, shape="triangles"))
    turned = moved(first, 0.7, 1.0, (30, 0, 0))
    same, own = automatic_maps([first, turned], main="seamless", tiles=600, direction=(1.0, 0.0, 0.0))
    assert not np.array_equal(same.uv, own.uv)


@pytest.mark.parametrize("threads", [1, 2])
def test_maps_have_the_same_bits_at_any_number_of_threads(threads):
    parts = [families.torus(12, 8), families.geodesic_sphere(4), families.cube(), families.torus(16, 9)]
    scaled = [replace(parts[0], vertices=scale * parts[0].vertices) for scale in (0.5, 2.0)]
    surface = surface_of(families.united(*parts, *scaled))
    expected, made = automatic_maps(surface, threads=4), automatic_maps(surface, threads=threads)
    assert all(np.array_equal(a.uv, b.uv) and a.kind == b.kind for a, b in zip(expected, made, strict=True))


def test_progress_never_goes_back():
    surface = surface_of(families.united(families.torus(12, 8), families.cube(), families.cylinder(12, 8)))
    told = []
    automatic_maps(surface, threads=1, progress=lambda fraction, _stage: told.append(fraction))
    assert told and told == sorted(told)
