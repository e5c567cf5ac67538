"""Parts that are smooth between hard edges: whole tiles around their tubes, islands on the rest."""

import families
import holomorph
import numpy as np
import pytest
from holomorph import Surface, _native, automatic_map, automatic_maps
from holomorph.maps.arrangement import Arrangement, arranged
from holomorph.maps.report import part_report
from holomorph.mesh.edges import following_corners, polygon_sides
from holomorph.quality.quality import Quality
from solved import surface_of

EXACT = 1e-12
RINGS = 6
HEIGHTS = np.linspace(-1, 1, RINGS + 1)


def capped(radii, n, stretch=1.0):
    """Rings of n quads one above the other, then a polygon at each end. stretch : of the heights, by which all or each
    are multiplied"""
    turn = 2 * np.pi * np.arange(n) / n
    rings = [np.stack([r * np.cos(turn), r * np.sin(turn), 0 * turn + z], 1) for r, z in zip(radii, stretch * HEIGHTS)]
    a, b = np.arange(n), (np.arange(n) + 1) % n
    quads = [np.stack([a, b, b + n, a + n], axis=1) + k * n for k in range(RINGS)]
    return Surface(np.concatenate(rings), [*np.concatenate(quads).tolist(), a[::-1].tolist(), (a + RINGS * n).tolist()])


SHAPES = {f"cylinder of {n}": (1 + 0 * HEIGHTS, n) for n in (8, 16, 32, 64)}
SHAPES |= {f"frustum up to {top}": (np.linspace(1, top, RINGS + 1), 32) for top in (0.85, 0.7, 0.5)}
SHAPES |= {f"barrel of {bulge}": (1 - bulge * HEIGHTS**2, 32) for bulge in (0.1, 0.25)}
SHAPES["thin cylinder"] = (0.1 + 0 * HEIGHTS, 16, 3.0)


@pytest.fixture(scope="module", params=SHAPES)
def mapped(request):
    """(surface, its map)."""
    surface = capped(*SHAPES[request.param])
    return surface, automatic_map(surface)


def jumps(surface, uv):
    """(n, 2) of the UVs between neighbouring quads, at both ends of their edges."""
    following, ends = following_corners(surface), np.sort(polygon_sides(surface), axis=1)
    edges = ends[:, 0] * len(surface.vertices) + ends[:, 1]
    is_quad = np.repeat(np.diff(surface.face_offsets) == 4, np.diff(surface.face_offsets))
    order = np.argsort(np.where(is_quad, edges, -1), kind="stable")[np.count_nonzero(~is_quad) :]
    both = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, other = order[both], order[both + 1]
    return np.concatenate([uv[one] - uv[following[other]], uv[following[one]] - uv[other]])


def pieces(surface):
    """The tube and its ends, as (surface, corner in the whole)."""
    count = len(surface.face_offsets) - 1
    names = np.maximum(np.arange(count) - count + 3, 0).astype(np.int32)
    return [(own, corners) for own, _, _, corners in _native.cut_apart(surface.components[0]._native, names)]


def test_whole_tiles_lie_around_the_tube(mapped):
    surface, made = mapped
    found = jumps(surface, made.uv)
    assert made.kind == "mixed" and np.abs(found - np.round(found)).max() <= EXACT
    assert np.abs(found).max() >= 1  # else the tube would not be cut open


def test_pieces_have_one_density_and_every_face_an_area(mapped):
    surface, made = mapped
    found = [Quality.of(own, np.ascontiguousarray(made.uv[corners]), 0) for own, corners in pieces(surface)]
    medians = [quality.median_density for quality in found]
    assert max(medians) < 1.1 * min(medians) and made.density == pytest.approx(np.median(medians), rel=0.1)
    for quality in found:
        assert (quality.area > 0).all() and not quality.flipped.any() and not quality.collapsed.any()


def test_no_seam_is_seen_but_at_the_ends(mapped):
    """Where UVs jump along the tube they jump by whole tiles: the seams are those of the tiling and the two rims."""
    surface, made = mapped
    (tiling,) = made.tilings
    rims = surface.vertices[made.seams][:, :, 2].astype(np.float32)
    is_rim = np.abs(rims).min(axis=1) == np.abs(surface.vertices[:, 2]).max().astype(np.float32)
    is_rim &= rims[:, 0] == rims[:, 1]
    n = len(surface.vertices) // (RINGS + 1)
    assert np.count_nonzero(is_rim) == 2 * n and len(made.seams) == 2 * n + len(tiling.seams)
    assert not len(made.poles) and made.soft_length == pytest.approx(0, abs=EXACT)


def test_the_quality_is_that_of_the_whole_map(mapped):
    surface, made = mapped
    own = Quality.of(surface._native, made.uv, 0)
    assert made.quality.mean_angle == pytest.approx(own.mean_angle, rel=1e-5)
    assert made.quality.density_ratio == pytest.approx(own.density_ratio, rel=1e-3)
    assert made.verdict.is_fit


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_the_map_is_the_same_at_any_number_of_threads(mapped, threads):
    surface, made = mapped
    assert np.array_equal(automatic_map(surface, threads=threads).uv, made.uv)


def test_whole_tiles_stay_whole_beside_other_parts(mapped):
    """Turned by quarters, in the single precision that applications store."""
    surface, alone = mapped
    both = families.united(families.torus(16, 10, R=3.0), *[mesh_of(surface)] * 2)
    maps, corners = automatic_maps(surface_of(both), density=alone.density), len(both.corners)
    for quarters in range(4):
        uv = arranged(maps, corners, Arrangement(quarters=quarters)).astype(np.float32)
        for made in maps[1:]:
            found = jumps(surface, uv[made.surface.corner_index])
            assert made.kind == "mixed" and np.array_equal(found, np.round(found))


def mesh_of(surface):
    return families.Mesh(surface.vertices, surface.corner_vertices, surface.face_offsets, ((0, 0),))


def test_a_copy_has_the_map_of_its_part():
    first = capped(*SHAPES["barrel of 0.1"])
    copy = Surface.from_polygons(2 * first.vertices + 10, first.corner_vertices, first.face_offsets)
    made = automatic_maps([first, copy], density=6.0)
    own, verdict = Quality.of(copy._native, made[1].uv, 0), made[1].verdict
    assert made[1].kind == "mixed" and made[1].surface is copy and verdict == made[0].verdict
    assert made[1].density == pytest.approx(own.median_density, rel=0.05)
    assert made[0].density == pytest.approx(made[1].density, rel=0.1)


def test_parts_in_pieces_have_the_density_of_a_rigid_one():
    """A ball takes whole tiles alone; the tube of a can, though it is larger, is stretched."""
    ball, can = families.geodesic_sphere(6), mesh_of(capped(*SHAPES["cylinder of 32"]))
    ball = families.Mesh(0.8 * ball.vertices, ball.corners, ball.offsets, ((0, 0),))
    parts = surface_of(families.united(ball, can))
    made, alone = (automatic_maps(parts, main=["automatic", main]) for main in ("automatic", "untiled"))
    assert [found.kind for found in made] == ["tiling", "mixed"] and np.array_equal(made[0].uv, alone[0].uv)
    assert made[1].density == pytest.approx(made[0].density, rel=0.1)


def test_a_smaller_copy_weighs_less():
    """Two different maps, one of a copy of a third of the size."""
    first, other = capped(*SHAPES["barrel of 0.25"]), capped(*SHAPES["frustum up to 0.5"])
    small = Surface.from_polygons(first.vertices / 3, first.corner_vertices, first.face_offsets)
    maps = [automatic_map(one, main="untiled", evenness=0) for one in (first, other)]
    copied = Quality.joined([maps[0].quality.of_copy(1 / 3), maps[1].quality], [1.0, 1.0])
    own = Quality.joined([Quality.of(small._native, maps[0].uv, 0), maps[1].quality], [1.0, 1.0])
    assert copied.density_ratio == pytest.approx(own.density_ratio, rel=1e-9)
    assert copied.mean_angle == pytest.approx(own.mean_angle, rel=1e-9)


def test_faces_that_are_read_in_reverse_are_not_mirrored():
    surface = capped(*SHAPES["cylinder of 32"])
    faces = np.split(surface.corner_vertices, surface.face_offsets[1:-1])
    made = automatic_map(Surface(surface.vertices, [face[::-1] if k % 3 else face for k, face in enumerate(faces)]))
    assert made.kind == "mixed" and not Quality.of(made.surface._native, made.uv, 0).flipped.any()


def test_progress_grows_and_cancels():
    surface, told = capped(*SHAPES["barrel of 0.25"]), []
    automatic_map(surface, progress=lambda fraction, _stage: told.append(fraction))
    assert told and told == sorted(told) and told[-1] <= 1
    for limit in (0.0, 0.5, 0.75):  # at once, among the first maps, among the pieces
        with pytest.raises(holomorph.Cancelled):
            automatic_map(surface, progress=lambda fraction, _, limit=limit: fraction < limit)


def test_what_is_asked_for_is_not_divided():
    surface = capped(*SHAPES["cylinder of 32"])
    assert automatic_map(surface, main="untiled").kind == "islands"
    assert automatic_map(surface, main="seamless").kind == "tiling"
    assert automatic_map(surface, poles=4).kind != "mixed"


def test_flat_pieces_and_steep_cones_stay_islands():
    cube = automatic_map(surface_of(families.cube()))
    assert cube.kind == "islands" and cube.islands == 1 and len(cube.seams) == 7
    assert cube.quality.density_ratio == pytest.approx(1, abs=1e-9)
    assert automatic_map(capped(np.linspace(1, 0.2, RINGS + 1), 32)).kind == "islands"
    assert automatic_map(capped(1 + 0 * HEIGHTS, 6)).kind == "islands"  # its edges hide all seams


def test_the_report_tells_of_the_tilings():
    made = automatic_map(capped(*SHAPES["cylinder of 32"]))
    entry = part_report(made)
    assert entry["main_map"]["kind"] == "mixed" and "whole tiles" in entry["main_map"]["why"] and "tiling" not in entry
    assert [tiling["poles"] for tiling in entry["tilings"]] == [[]]


def with_window(surface, first, count):
    """Without some of its quads, next to each other in each of the two middle rings."""
    n = len(surface.vertices) // (RINGS + 1)
    faces = np.split(surface.corner_vertices, surface.face_offsets[1:-1])
    gone = {k * n + first + i for k in (RINGS // 2 - 1, RINGS // 2) for i in range(count)}
    return Surface(surface.vertices, [face.tolist() for k, face in enumerate(faces) if k not in gone])


@pytest.mark.parametrize("count", [1, 3, 9])
def test_whole_tiles_lie_around_a_tube_with_a_window(count):
    surface = with_window(capped(*SHAPES["cylinder of 32"]), 4, count)
    made = automatic_map(surface)
    found = jumps(surface, made.uv)
    assert made.kind == "mixed" and np.abs(found - np.round(found)).max() <= EXACT
    assert made.quality.density_ratio < 1.02  # without the window it is 1


def test_softer_edges_divide_where_the_hard_ones_leave_what_stretches():
    """A bottle whose shoulder bends by 50 degrees at both ends: two tubes of different widths."""
    radii, heights = np.array([1, 1, 1, 1, 0.4, 0.4, 0.4]), np.array([-2, -1.2, -0.6, 0, 0.5, 1.2, 1.8])
    surface = capped(radii, 32, stretch=heights / np.where(HEIGHTS == 0, 1, HEIGHTS))
    made = automatic_map(surface)
    densities = [tiling.quality.median_density for tiling in made.tilings]
    assert made.kind == "mixed" and len(densities) >= 2 and max(densities) < 1.1 * min(densities)
    assert made.quality.density_ratio < 1.5
