"""A picture raised on a tiling: closed where the surface is, heights alike on both sides of seams, no crossings."""

import holomorph
import numpy as np
import pytest
from heights import DEPTH, dots
from holomorph import Surface, TiledSurface, automatic_map
from holomorph.tiles.relief import joined, normals, plain, volume
from solved import surface_of
from tiled_families import CASES, MORE, tiled, tiling
from tiled_grids import flat_square, grid_torus

CLOSED = [name for name in CASES | MORE if not surface_of((CASES | MORE)[name][0]).boundary_count]
OPEN = [name for name in CASES | MORE if name not in CLOSED]
FEW = 40_000  # triangles
EXACT = 1e-9


def waves(size=32):
    """Heights from 0 to 1 that repeat."""
    x = 2 * np.pi * (np.arange(size) + 0.5) / size
    return 0.5 + 0.25 * np.cos(x)[:, None] + 0.25 * np.cos(2 * x)


def sampled(heights, uv):
    """Bilinear between the middles of pixels, which repeat."""
    rows, columns = heights.shape
    x, y = uv[:, 0] % 1 * columns - 0.5, rows - uv[:, 1] % 1 * rows - 0.5
    j, i = np.floor(x).astype(int), np.floor(y).astype(int)
    p, q = x - j, y - i

    def at(di, dj):
        return heights[(i + di) % rows, (j + dj) % columns]

    return (1 - q) * ((1 - p) * at(0, 0) + p * at(0, 1)) + q * ((1 - p) * at(1, 0) + p * at(1, 1))


def sides(triangles):
    return np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)


def boundary(triangles):
    """(n, 2) sides without another one back. Raises AssertionError where a side is there twice."""
    each, count = sides(triangles), triangles.max() + 1
    keys, back = each @ (count, 1), each @ (1, count)
    assert len(np.unique(keys)) == len(keys)
    return each[~np.isin(keys, back)]


def characteristic(triangles):
    edges = np.unique(np.sort(sides(triangles), axis=1), axis=0)
    return len(np.unique(triangles)) - len(edges) + len(triangles)


def raised(name, heights=None, depth=DEPTH, **options):
    return tiled(name).relief(waves() if heights is None else heights, depth, most_triangles=FEW, **options)


@pytest.mark.parametrize("name", CASES | MORE)
def test_it_is_as_closed_and_connected_as_the_surface(name):
    surface = tiled(name).surface
    made = raised(name)
    assert len(made.triangles) > len(surface.triangles)
    assert characteristic(made.triangles) == surface.euler_characteristic
    border = boundary(made.triangles)
    assert bool(len(border)) == (name in OPEN)
    original = boundary(surface.triangles)
    length = [
        np.linalg.norm(made.base[each[:, 0]] - made.base[each[:, 1]], axis=1).sum() for each in (border, original)
    ]
    assert length[0] == pytest.approx(length[1])


@pytest.mark.parametrize("name", CLOSED)
def test_others_find_it_watertight(name):
    """trimesh and manifold3d on what is written for printers."""
    trimesh, manifold = pytest.importorskip("trimesh"), pytest.importorskip("manifold3d")
    made = raised(name, dots())
    mesh = trimesh.Trimesh(made.vertices, made.triangles, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert made.volume == pytest.approx(mesh.volume)
    solid = manifold.Manifold(manifold.Mesh(made.vertices.astype(np.float32), made.triangles.astype(np.uint32)))
    assert solid.status() == manifold.Error.NoError
    assert solid.genus() == tiled(name).surface.genus
    assert solid.volume() == pytest.approx(made.volume, rel=1e-3)


@pytest.mark.parametrize("name", CASES | MORE)
def test_heights_are_those_of_the_tiles_on_all_sides(name):
    """Every corner of every triangle, on whichever side of a seam, lies where the picture has the height of its vertex;
    but near poles, where they fade out."""
    on, heights = tiled(name), waves()
    made = raised(name)
    inside = np.linalg.solve(on.lattice, made.uv.T).T
    found = made.heights[made.corner_vertices]
    at = sampled(heights, inside)
    if not len(on.poles):
        assert np.abs(found - at).max() < EXACT
        return
    assert (found <= at + EXACT).all()
    is_pole = np.isin(on.surface.triangles, on.poles).any(axis=1)
    assert (made.heights[on.surface.triangles[is_pole]] == 0).all()
    far = on.surface.vertices[on.poles]
    apart = np.linalg.norm(made.vertices[made.corner_vertices][:, None] - far, axis=2).min(axis=1)
    away = apart > np.quantile(apart, 0.95)
    assert np.abs(found - at)[away].mean() < np.abs(found - at)[~away].mean() + EXACT


@pytest.mark.parametrize("name", ["torus without poles", "genus 2 without poles", "knot"])
def test_volume_grows_by_the_heights_and_the_area(name):
    made = raised(name, depth=1e-4)
    corners = made.base[made.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    expected = (areas * made.heights[made.triangles].mean(axis=1)).sum() * made.depth
    assert made.volume - volume(made.base, made.triangles) == pytest.approx(expected, rel=0.02)
    assert volume(made.base, made.triangles) == pytest.approx(volume(*_whole(name)))


def _whole(name):
    return tiled(name).surface.vertices, tiled(name).surface.triangles


def test_it_is_near_the_picture_everywhere():
    made = grid_torus(24, 18, 6, 4).relief(waves(), DEPTH, tolerance=0.05)
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], len(made.triangles))
    at = np.einsum("tk,tkx->tx", weights, made.uv.reshape(-1, 3, 2))
    flat = np.einsum("tk,tk->t", weights, made.heights[made.triangles])
    assert not made.is_full
    assert made.error <= 0.05
    assert np.abs(sampled(waves(), at) - flat).max() < 2 * 0.05


def test_flat_parts_of_the_picture_stay_coarse():
    picture = np.zeros((64, 64))
    picture[:8, :8] = 1
    made = grid_torus(24, 18, 3, 2).relief(picture, DEPTH)
    size = np.linalg.norm(np.cross(*np.diff(made.base[made.triangles], axis=1).swapaxes(0, 1)), axis=1)
    is_flat = np.ptp(made.heights[made.triangles], axis=1) == 0
    assert np.mean(size[is_flat]) > 10 * np.mean(size[~is_flat])


def test_no_pixel_is_missed():
    """One white pixel of a million on a tile of two triangles."""
    picture = np.zeros((1024, 1024))
    picture[300, 700] = 1
    made = TiledSurface(*flat_square(0.0, quads=1)).relief(picture, DEPTH)
    assert made.heights.max() > 0.5
    assert len(made.triangles) < 2000


def test_angles_do_not_get_small():
    def least(vertices, triangles):
        a, b, c = np.moveaxis(vertices[triangles], 1, 0)
        angles = [
            np.arctan2(np.linalg.norm(np.cross(y - x, z - x), axis=1), np.einsum("ij,ij->i", y - x, z - x))
            for x, y, z in ((a, b, c), (b, c, a), (c, a, b))
        ]
        return np.min(angles)

    on = tiled("torus without poles")
    made = raised("torus without poles", dots())
    assert least(made.base, made.triangles) > 0.49 * least(on.surface.vertices, on.surface.triangles)


def test_whole_tiles_between_triangles_change_nothing():
    on = grid_torus(14, 11, 7, 5)
    jumps = np.random.default_rng(3).integers(-3, 4, (len(on.surface.triangles), 2))
    moved = TiledSurface(on.surface, on.uv + np.repeat(jumps, 3, axis=0))
    one, other = (each.relief(dots(), DEPTH) for each in (on, moved))
    assert len(one.triangles) == pytest.approx(len(other.triangles), rel=1e-2)  # rounding decides some
    assert one.volume == pytest.approx(other.volume, rel=1e-4)


def test_the_same_at_any_number_of_threads():
    on = tiled("genus 2")
    one = TiledSurface(on.surface, on.uv, threads=1).relief(dots(), DEPTH, most_triangles=FEW)
    other = TiledSurface(on.surface, on.uv, threads=3).relief(dots(), DEPTH, most_triangles=FEW)
    assert one.vertices.tobytes() == other.vertices.tobytes()
    assert one.crossings.tobytes() == other.crossings.tobytes()


def test_as_many_triangles_as_are_allowed():
    on = tiled("torus without poles")
    made = [on.relief(dots(), DEPTH, most_triangles=most) for most in (1, 2000, 8000)]
    assert [len(one.triangles) for one in made[:1]] == [len(on.surface.triangles)]
    assert all(one.is_full for one in made)
    assert len(made[1].triangles) <= 2000 < len(made[2].triangles) <= 8000
    assert made[0].error >= made[1].error >= made[2].error > 0.02


def test_a_picture_twice_in_a_tile_is_that_of_two_by_two():
    on = grid_torus(14, 11, 7, 5)
    twice, once = on.relief(waves(16), DEPTH, repeats=2), on.relief(np.tile(waves(16), (2, 2)), DEPTH)
    assert np.abs(twice.heights - sampled(np.tile(waves(16), (2, 2)), twice.uv)[_first_corner(twice)]).max() < EXACT
    assert twice.volume == pytest.approx(once.volume, rel=1e-3)


def _first_corner(made):
    """(#V,) a corner at each vertex."""
    return np.unique(made.corner_vertices, return_index=True)[1]


def test_the_level_stays():
    engraved, both = (raised("torus without poles", level=level) for level in (1, 0.5))
    assert engraved.heights.max() <= 0
    assert both.heights.min() < 0 < both.heights.max()
    assert volume(engraved.base, engraved.triangles) > engraved.volume > 0


def test_faces_of_boxes_stay_parallel():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    assert np.allclose(normals(Surface(corners, faces))[0], 2 * corners - 1)


def narrow_torus():
    """Whose hole is 0.4 wide."""
    at = grid_torus(32, 24, 8, 4)
    i, j = np.divmod(np.arange(32 * 24), 24)
    a, b = 2 * np.pi * i / 32, 2 * np.pi * j / 24
    vertices = np.stack([(1.2 + np.cos(b)) * np.cos(a), (1.2 + np.cos(b)) * np.sin(a), np.sin(b)], axis=1)
    return TiledSurface(Surface(vertices, at.surface.triangles), at.uv)


def exact_crossings(made):
    """How many pairs of triangles libigl's exact arithmetic finds."""
    cgal = pytest.importorskip("igl.copyleft.cgal")
    return len(cgal.remesh_self_intersections(made.vertices, made.triangles.astype(np.int64), detect_only=True)[2])


@pytest.mark.parametrize(("depth", "crosses"), [(0.15, False), (0.5, True)])
def test_it_crosses_itself_above_the_size_of_the_hole(depth, crosses):
    made = narrow_torus().relief(waves(8), depth, tolerance=0.2)
    assert bool(len(made.crossings)) == crosses
    assert bool(exact_crossings(made)) == crosses
    assert (made.safe_depth < depth) == crosses
    if crosses:
        assert made.safe_depth > 0.15
        assert not len(made.at_depth(made.safe_depth).crossings)
        assert not exact_crossings(made.at_depth(made.safe_depth))


@pytest.mark.parametrize("name", ["sphere", "torus without poles", "genus 3", "knot"])
def test_none_crosses_below_the_size_of_its_features(name):
    made = raised(name, waves(8), tolerance=0.1)
    assert not len(made.crossings)
    assert not exact_crossings(made)


def test_crossings_are_those_of_exact_arithmetic():
    """Triangles in space at random, which have no vertex in common."""
    cgal = pytest.importorskip("igl.copyleft.cgal")
    vertices = np.random.default_rng(5).uniform(-1, 1, (180, 3))
    triangles = np.arange(180, dtype=np.int32).reshape(-1, 3)
    pairs = cgal.remesh_self_intersections(vertices, triangles.astype(np.int64), detect_only=True)[2]
    found = holomorph._native.crossings(vertices, triangles, threads=2)
    assert {*map(tuple, found.tolist())} == {*map(tuple, np.sort(pairs, axis=1).tolist())}
    assert len(found) > 50


def test_parts_are_joined_and_others_stay_plain():
    one, other = raised("torus"), plain(tiled("sphere").surface)
    both = joined([one, other])
    assert both.depth == one.depth
    assert both.volume == pytest.approx(one.volume + volume(*_whole("sphere")))
    assert np.array_equal(both.vertices[len(one.base) :], tiled("sphere").surface.vertices)
    assert "deep" in repr(both)


def test_a_map_that_is_no_tiling_is_refused():
    found = automatic_map(surface_of(CASES["torus"][0]), main="balanced")
    with pytest.raises(holomorph.TopologyError, match="not a tiling"):
        found.tiled.relief(waves(), DEPTH)
    with pytest.raises(holomorph.TopologyError, match="not a tiling"):
        TiledSurface(surface_of(CASES["torus"][0]), tiling("torus").uv * 0.9)


BAD = {
    "no depth": ({"depth": 0.0}, "depth is 0.0; a positive"),
    "negative depth": ({"depth": -1}, "depth is -1; a positive"),
    "depth that is not a number": ({"depth": float("nan")}, "depth is nan"),
    "endless depth": ({"depth": float("inf")}, "depth is inf"),
    "depth above the mesh": ({"depth": 1e3}, "more than the size of the whole mesh"),
    "no array": ({"heights": "hills"}, "heights is not an array"),
    "colours": ({"heights": np.ones((4, 4, 3))}, r"heights has the shape \(4, 4, 3\)"),
    "no pixels": ({"heights": np.empty((0, 4))}, r"heights has the shape \(0, 4\)"),
    "one pixel": ({"heights": np.ones((1, 1))}, "the height 1 everywhere"),
    "one height": ({"heights": np.full((9, 9), 0.3)}, "the height 0.3 everywhere"),
    "heights above 1": ({"heights": 2 * waves()}, "from 0 to 1"),
    "a pixel that is not a number": ({"heights": np.where(waves() > 0.9, np.nan, waves())}, "finite numbers"),
    "no repeats": ({"repeats": 0}, "repeats has 0"),
    "level": ({"level": 1.5}, "level is 1.5"),
    "tolerance": ({"tolerance": -0.1}, "tolerance is -0.1"),
    "no triangles": ({"most_triangles": 0}, "most_triangles is 0"),
    "no fade": ({"pole_fade": 0}, "pole_fade is 0"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused(name):
    given, message = BAD[name]
    with pytest.raises(ValueError, match=message):
        tiled("torus").relief(**{"heights": waves(), "depth": DEPTH} | given)


def test_it_is_cancelled():
    with pytest.raises(holomorph.Cancelled):
        tiled("torus").relief(dots(), DEPTH, progress=lambda fraction, stage: False)
