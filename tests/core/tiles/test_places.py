"""Places in the tiles of a surface: each once, and as many as the area asks for."""

import pickle

import families
import holomorph
import numpy as np
import pytest
from holomorph import SolverError, Surface, TiledSurface, TopologyError, automatic_map
from solved import surface_of
from tiled_families import CASES, MORE, renumbered, same_points, tiled, tiling
from tiled_grids import flat_square

EXACT = 1e-12
NEAR = 1e-9  # of a tile: what is decided at such a distance may be rounding
LITTLE = np.array([1e-5, 3e-6])
GRIDS = {
    "middles": {},
    "corners": {"offset": (0, 0)},
    "sides": {"offset": (0.5, 0)},
    "many": {"per_tile": (2, 3), "offset": (0.3, 0.17)},
    "shifted": {"per_tile": (3, 2), "shifted_rows": True, "offset": (0.41, 0.23)},
}
everywhere = pytest.mark.parametrize("name", CASES | MORE)
on_grids = pytest.mark.parametrize("grid", GRIDS)


def coordinates(on, per_tile=(1, 1), offset=(0.5, 0.5), shifted_rows=False):
    """(#T, 3, 2) of the triangles' corners, integers at places."""
    columns, rows = per_tile
    steps = np.array([[columns, -rows / 2 if shifted_rows else 0], [0, rows]])
    inside = np.linalg.solve(on.lattice, on.uv.T).T
    return ((inside - np.divide(offset, per_tile)) @ steps.T)[on.surface.triangle_corners]


def areas(corners):
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return (ax * by - ay * bx) / 2


def border_sides(on):
    """(#T, 3) bool: the sides that have no other side with the same UVs up to whole tiles."""
    native = on.surface._native
    is_border = np.bincount(native.triangle_edges.ravel())[native.triangle_edges] == 1
    is_pole = np.isin(native.triangles, on.poles)
    return is_border | is_pole | np.roll(is_pole, -1, axis=1)


def excess(start, end):
    """How many more places than area there are on the left of the way along the sides, as if they closed up: with the
    saw tooth b(x) = 1/2 - (x - floor x) the places less the area are d(b(x) (1 + b'(y)) dy) - d(b(y) dx)."""
    total = 0.0
    for (x, y), (x2, y2) in zip(start, end):
        low, high = sorted((y, y2))
        for n in range(int(np.ceil(low)), int(np.floor(high)) + 1):
            at = x + (n - y) / (y2 - y) * (x2 - x)
            total += np.sign(y2 - y) * (np.floor(at) + 0.5 - at)
        f, f2 = y - np.floor(y), y2 - np.floor(y2)
        steep = abs(y2 - y) > NEAR
        mean = (f - f * f - f2 + f2 * f2) / (y - y2) / 2 if steep else 0.5 - f
        total -= mean * (x2 - x)
    return total


def on_boundary(places):
    """(n,) bool."""
    surface = places.tiled.surface
    native = surface._native
    is_border = np.bincount(native.triangle_edges.ravel()) == 1
    is_border_vertex = np.zeros(len(surface.vertices), bool)
    is_border_vertex[native.edges[is_border]] = True
    of_side = is_border[native.triangle_edges[places.triangles]] & (np.roll(places.barycentric, 1, axis=1) == 0)
    of_vertex = is_border_vertex[surface.triangles[places.triangles]] & (places.barycentric == 1)
    return (of_side | of_vertex).any(axis=1)


@everywhere
@on_grids
def test_they_are_as_many_as_the_area_and_the_border_ask_for(name, grid):
    """Moved a little this way or the other, half of those on the boundary leave the surface."""
    on, options = tiled(name), GRIDS[grid]
    places, corners = on.places(**options), coordinates(on, **options)
    side = border_sides(on)
    area, ends = areas(corners).sum(), (corners[side], np.roll(corners, -1, axis=1)[side])
    expected = [area + excess(*(each + sign * LITTLE for each in ends)) for sign in (1, -1)]
    more = len(places) - places.flipped - (sum(expected) + on_boundary(places).sum()) / 2
    assert abs(more) < 1e-6 + (places.flipped / 2 if on_boundary(places).any() else 0)  # a half for one in both
    assert len(places) > 30
    if not side.any():
        assert abs(area - np.rint(area)) < 1e-6


@everywhere
@on_grids
def test_they_lie_where_their_numbers_say(name, grid):
    on, options = tiled(name), GRIDS[grid]
    places, corners = on.places(**options), coordinates(on, **options)
    found = np.einsum("ni,nij->nj", places.barycentric, corners[places.triangles])
    assert np.abs(found - np.rint(found)).max() < NEAR
    assert places.barycentric.min() >= 0
    assert np.abs(places.barycentric.sum(axis=1) - 1).max() < EXACT
    uv = np.einsum("ni,nij->nj", places.barycentric, on.uv[on.surface.triangle_corners[places.triangles]])
    shift = np.linalg.solve(on.lattice, (uv - places.uv).T)
    is_own = ~np.isin(on.surface.triangles[places.triangles], on.poles).any(axis=1)
    assert np.abs(shift - np.rint(shift))[:, is_own].max() < NEAR
    inside = np.linalg.solve(on.lattice, places.uv.T).T - places.tiles
    assert inside.min() > -NEAR and inside.max() < 1 + NEAR


@everywhere
def test_none_is_nearer_than_half_a_tile_but_at_poles_branches_and_folds(name):
    on = tiled(name)
    places = on.places(per_tile=(2, 2))
    shorter = np.linalg.svd(places.tangents, compute_uv=False)[:, 1]  # evened tiles are sheared
    sizes = np.minimum(shorter[:, None], shorter) / 2
    native = on.surface._native
    folds = native.triangles[areas(coordinates(on)) < NEAR].ravel()
    centres = np.concatenate([on.poles, tiling(name).zeros[0], folds]).tolist()
    distances = native.edge_distances(native.edge_lengths, centres) if centres else np.full(native.vertex_count, np.inf)
    is_centre = np.isin(native.triangles, centres).any(axis=1)
    star = distances[native.triangles[is_centre]].max(initial=0)
    kept = places.of(distances) > np.maximum(star, places.sizes)
    distance = np.linalg.norm(places.positions[:, None] - places.positions, axis=2) / sizes
    np.fill_diagonal(distance, np.inf)
    assert kept.sum() > 20
    assert distance.min(axis=1)[kept].min() > 0.5


@everywhere
def test_they_are_the_same_in_any_numbering(name):
    on, other = tiled(name), renumbered(tiled(name))
    for options in GRIDS.values():
        assert same_points(on.places(**options).positions, other.places(**options).positions, NEAR)


@everywhere
def test_no_thread_changes_a_bit(name):
    on = tiled(name)
    one = TiledSurface(on.surface, on.uv, on.lattice, threads=1).places(per_tile=(9, 9))
    two = TiledSurface(on.surface, on.uv, on.lattice, threads=2).places(per_tile=(9, 9))
    for attribute in ("triangles", "barycentric", "uv", "tiles"):
        assert (getattr(one, attribute) == getattr(two, attribute)).all()


@everywhere
def test_poles_are_found_in_the_uvs(name):
    assert sorted(tiled(name).poles) == sorted(tiling(name).poles)
    single = TiledSurface(tiled(name).surface, tiling(name).uv.astype(np.float32), tiling(name).lattice)
    assert sorted(single.poles) == sorted(tiling(name).poles)


@pytest.mark.parametrize("shift", [(0, 0), (0.5, 0), (0.5, 0.5), (0.25, 0)])
@pytest.mark.parametrize("grid", [{}, {"offset": (0, 0)}, {"per_tile": (2, 2), "offset": (0, 0)}])
def test_edges_vertices_and_the_boundary_have_them_once(shift, grid):
    surface, uv = flat_square(shift)
    places = TiledSurface(surface, uv).places(**grid)
    columns = grid.get("per_tile", (1, 1))[0]
    offset = grid.get("offset", (0.5, 0.5))[0]
    counts = [len([n for n in range(-9, 99) if s <= (n + offset) / columns <= s + 4]) for s in shift]
    assert len(places) == counts[0] * counts[1]
    assert len(np.unique(places.positions.round(9), axis=0)) == len(places)
    assert np.abs(places.uv - shift - places.positions[:, :2]).max() < EXACT
    assert (places.sheets == 0).all()
    assert np.isinf(places.pole_distances).all()


def test_a_branch_that_is_hit_is_one_place():
    """Four squares around a vertex twice: the middle is a zero."""
    angle = np.arange(8) * np.pi / 4
    ring = np.stack([np.cos(angle), np.sin(angle), 0.2 * np.cos(2 * angle)], axis=1)
    faces = np.stack([np.zeros(8, int), 1 + np.arange(8), 1 + (np.arange(8) + 1) % 8], axis=1)
    corner = 0.7 * np.exp(0.5j * np.pi * np.arange(9))
    uv = np.stack([np.zeros(8), corner[:-1], corner[1:]], axis=1).ravel()
    places = TiledSurface(Surface([[0, 0, 0], *ring], faces), np.stack([uv.real, uv.imag], 1)).places(offset=(0, 0))
    assert len(places) == 1 and np.abs(places.positions).max() == 0
    around = TiledSurface(Surface([[0, 0, 0], *ring], faces), np.stack([uv.real, uv.imag], 1)).places(offset=(0.1, 0.1))
    assert len(around) == 2 and around.sheets.tolist() == [0, 1]


def test_of_a_fold_one_layer_is_left_out():
    square, uv = flat_square((0, 0), quads=4)
    x = uv[:, 0]
    folded = np.where(x == 2, 3.25, np.where(x == 3, 1.75, x))  # forth, back and forth
    places = TiledSurface(square, np.stack([folded, uv[:, 1]], axis=1)).places()
    assert places.flipped == 4
    assert len(places) - places.flipped == 16


def test_tangents_normals_and_sizes_are_those_of_the_triangles():
    on = tiled("torus")
    places = on.places()
    du, dv = np.moveaxis(places.tangents, 1, 0)
    step = 1e-6
    shifted = on.uv[on.surface.triangle_corners[places.triangles]]
    (a, b, c), corners = np.moveaxis(shifted, 1, 0), on.surface.vertices[on.surface.triangles[places.triangles]]
    for along, tangent in (([step, 0], du), ([0, step], dv)):
        at = np.linalg.solve(np.stack([b - a, c - a], axis=2), np.broadcast_to(along, a.shape)[..., None])[..., 0]
        moved = np.einsum("ni,nij->nj", at, corners[:, 1:] - corners[:, :1]) / step
        assert np.abs(moved - tangent).max() < 1e-9
    assert np.abs(np.einsum("ni,ni->n", places.normals, du)).max() < EXACT * 10
    assert np.abs(np.linalg.norm(places.normals, axis=1) - 1).max() < EXACT
    assert np.abs(places.sizes**2 - np.linalg.norm(np.cross(du, dv), axis=1)).max() < EXACT
    assert (np.einsum("ni,ni->n", np.cross(du, dv), places.normals) > 0).all()
    assert (places.pole_distances >= 0).all() and np.isfinite(places.pole_distances).all()
    to_pole = np.linalg.norm(places.positions[:, None] - on.surface.vertices[on.poles], axis=2).min(axis=1)
    assert (places.pole_distances >= to_pole - EXACT).all()


def test_they_survive_a_pickle():
    places = tiled("sphere").places()
    again = pickle.loads(pickle.dumps(places))
    assert (again.positions == places.positions).all() and repr(again) == repr(places)
    assert len(again.tiled.places()) == len(places)


def test_a_map_gives_them():
    found = automatic_map(surface_of(CASES["torus"][0]), main="seamless", tiles=60)
    assert len(found.tiled.places()) > 30
    balanced = automatic_map(surface_of(CASES["torus"][0]), main="balanced")
    with pytest.raises(TopologyError, match="not a tiling: its kind is 'forms'"):
        _ = balanced.tiled


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"per_tile": 2}, "per_tile is 2; two numbers"),
        ({"per_tile": (0, 1)}, "per_tile has 0; whole numbers from 1"),
        ({"per_tile": (1.5, 1)}, "per_tile has 1.5; whole numbers"),
        ({"per_tile": (1, 10**9)}, "per_tile has 1000000000"),
        ({"offset": (0.5, np.nan)}, "two finite numbers"),
        ({"offset": "ab"}, "offset is 'ab'; two numbers"),
        ({"shifted_rows": True}, "an even number of rows"),
    ],
)
def test_bad_options_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        tiled("torus").places(**options)


def test_too_many_tiles_are_refused():
    surface, uv = flat_square((0, 0))
    on = TiledSurface(surface, uv * 100)
    for ask in (on.places, on.cells):
        with pytest.raises(SolverError, match="tiles: too many"):
            ask(per_tile=(1000, 1000))
    with pytest.raises(SolverError, match="lines of tiles: too many"):
        TiledSurface(surface, uv * [1, 2e6]).lines("u", per_tile=3)


def test_maps_that_are_no_tilings_are_refused():
    surface, uv = flat_square((0, 0))
    closed = surface_of(families.cube())
    count = len(closed.corner_vertices)
    for bad, message in [
        (uv * np.nan, "a UV is not finite"),
        (uv * 1e9, "tiles apart"),
        (np.random.default_rng(0).normal(size=uv.shape), "a fraction of a tile at the edge between the vertices"),
    ]:
        with pytest.raises(TopologyError, match=message):
            TiledSurface(surface, bad)
    whole = np.random.default_rng(0).integers(0, 9, (count, 2)).astype(float)
    with pytest.raises(TopologyError, match="by different numbers of tiles at the two ends of the edge between"):
        TiledSurface(closed, whole)
    with pytest.raises(ValueError, match="uv has the shape"):
        TiledSurface(surface, uv[:-1])
    with pytest.raises(TypeError, match="a Surface is needed"):
        TiledSurface(None, uv)
    with pytest.raises(ValueError, match="lattice is 'round'"):
        TiledSurface(surface, uv, "round")
    flat = holomorph.Surface.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]])
    with pytest.raises(TopologyError, match="edge lengths only"):
        TiledSurface(flat, np.zeros((3, 2)))
