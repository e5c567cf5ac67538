"""Parts of a mesh: worked on side by side, copies once."""

import threading
from dataclasses import replace

import families
import holomorph
import numpy as np
import pytest
from holomorph import Cancelled, Surface, automatic_maps
from holomorph.core.progress import LARGE, side_by_side
from holomorph.mesh.copies import copies
from solved import surface_of

SIZES = [5, 700, 30, LARGE + 1, 12, LARGE, 90]


@pytest.mark.parametrize("threads", [1, 2, 7, None])
def test_results_are_in_the_order_of_the_parts(threads):
    asked = {}

    def work(k, own_threads, _progress):
        asked[k] = own_threads
        return k * k

    assert side_by_side(work, SIZES, threads) == [k * k for k in range(len(SIZES))]
    assert {k for k, own in asked.items() if own == threads} >= {3, 5}  # large parts keep all threads busy
    assert all(own == 1 for k, own in asked.items() if SIZES[k] < LARGE)


def test_of_several_errors_the_first_by_part_is_raised():
    def work(k, _threads, _progress):
        if k in (2, 4):
            raise ValueError(f"part {k}")

    with pytest.raises(ValueError, match="part 2"):
        side_by_side(work, [1] * 6, 1)


@pytest.mark.parametrize("sizes", [[1] * 8, [LARGE] * 3, [LARGE, 1, 1]])
def test_progress_grows_in_the_calling_thread_and_cancels(sizes):
    told, caller = [], threading.get_ident()

    def progress(fraction, stage):
        assert threading.get_ident() == caller
        told.append((fraction, stage))

    def work(_k, _threads, ask):
        waiting = threading.Event()
        for step in range(5):
            if not (ask is None or ask(step / 5, "working") is not False):
                raise Cancelled("stopped")
            waiting.wait(0.01)

    side_by_side(work, sizes, 2, progress)
    fractions = [fraction for fraction, _ in told]
    assert fractions and fractions == sorted(fractions) and fractions[-1] <= 1 + 1e-12
    with pytest.raises(Cancelled):
        side_by_side(work, sizes, 2, lambda *_: False)


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
    assert [copy.first for copy in found] == [0, 0, 0, 3, 4]
    assert found[2].scale == pytest.approx(2.5, rel=1e-6)


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
    assert [copy.first for copy in copies([first, far])] == [0, 0]
    vertices[40, 2] += 4 * longest
    other = Surface.from_polygons(vertices, first.corner_vertices, first.face_offsets)
    assert [copy.first for copy in copies([first, other])] == [0, 1]


@pytest.mark.parametrize("scale", [1.0, 0.37])
def test_polygons_with_corners_on_a_circle_are_cut_alike_in_all_copies(scale):
    """Both diagonals are as good, and rounding would choose another one in each copy."""
    first = surface_of(families.torus(24, 12))
    parts = [first, *(moved(first, angle, scale, (3, 4, 5)) for angle in (0.1, 0.7, 2.0))]
    assert all(np.array_equal(part.triangles, first.triangles) for part in parts)
    assert [copy.first for copy in copies(parts)] == [0] * 4


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
