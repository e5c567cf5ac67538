"""A polygon for each tile: whatever the map, the surface stays what it is."""

import families
import numpy as np
import pytest
from cell_checks import as_surface, assert_same_topology, inside, polygon_areas
from holomorph import TiledSurface
from solved import surface_of
from tiled_families import CASES, MORE, renumbered, same_points, tiled, tiling
from tiled_grids import flat_square, folded_torus, grid_torus, torus_uv

EXACT = 1e-9  # of a tile
everywhere = pytest.mark.parametrize("name", CASES | MORE)


def test_several_components_and_other_options():
    mesh = families.united(families.torus(12, 9, shape="triangles"), families.torus(12, 9, shape="triangles"))
    one = grid_torus(12, 9, 4, 3)
    both = TiledSurface(surface_of(mesh), np.concatenate([one.uv, one.uv]))
    assert len(both.cells()) == 2 * len(one.cells()) and len(both.places()) == 24 and len(both.lines()) == 6
    with pytest.raises(ValueError, match="an even number of rows"):
        one.cells(shifted_rows=True)
    with pytest.raises(ValueError, match="per_tile has 0"):
        one.cells(per_tile=(0, 1))


def area_outside_of_stars(on):
    corners = inside(on.cells(), on.uv)[on.surface.triangle_corners]
    a, b = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 0)
    kept = ~np.isin(on.surface.triangles, on.poles).any(axis=1)
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[kept].sum() / 2


@everywhere
def test_they_are_the_surface(name):
    cells = tiled(name).cells()
    assert_same_topology(cells, tiled(name).surface)
    assert_same_topology(cells.simplified(), tiled(name).surface)


@everywhere
def test_corners_are_whole_and_polygons_inside_of_tiles(name):
    cells = tiled(name).cells()
    at, in_tile = inside(cells, cells.uv), np.repeat(cells.poles < 0, np.diff(cells.face_offsets))
    assert np.abs(at - np.rint(at))[cells.is_corner].max() < EXACT
    relative = (at - np.repeat(cells.tiles, np.diff(cells.face_offsets), axis=0))[in_tile]
    assert relative.min() > -EXACT and relative.max() < 1 + EXACT
    on_side = (np.abs(at - np.rint(at)) < EXACT).any(axis=1)
    is_border = on_border(cells)[cells.corner_vertices]
    at_star = np.isin(cells.corner_vertices, cells.corner_vertices[~in_tile])
    of_part = np.repeat(~cells.is_whole, np.diff(cells.face_offsets))
    assert (on_side | is_border | at_star | of_part).all()


def on_border(cells):
    surface = as_surface(cells)
    native = surface._native
    border = native.edges[np.bincount(native.triangle_edges.ravel()) == 1]
    return np.isin(np.arange(len(cells.vertices)), border)


@everywhere
def test_they_have_the_area_of_the_map(name):
    cells = tiled(name).cells()
    areas = polygon_areas(cells)
    if not tiling(name).quality.flipped.any():
        assert np.abs(areas[cells.is_quad] - 1).max() < EXACT
    assert abs(areas[cells.poles < 0].sum() - area_outside_of_stars(tiled(name))) < 1e-7


@everywhere
def test_vertices_lie_where_their_uvs_say(name):
    cells, on = tiled(name).cells(), tiled(name)
    corners = on.surface.triangle_corners[cells.triangles]
    uv = np.einsum("ni,nij->nj", cells.barycentric, on.uv[corners])[cells.corner_vertices]
    in_star = np.isin(on.surface.triangles[cells.triangles], on.poles).any(axis=1)[cells.corner_vertices]
    jump = inside(cells, uv - cells.uv)[~in_star]
    assert np.abs(jump - np.rint(jump)).max() < EXACT
    assert np.abs(cells.of(on.surface.vertices) - cells.vertices).max() == 0


@pytest.mark.parametrize("name", ["torus without poles", "knot", "genus 2 without poles"])
def test_without_poles_all_are_quads_but_at_branches(name):
    """A branch of order k has 4 (k + 1) corners around it."""
    cells, surface = tiled(name).cells(), tiled(name).surface
    corners = np.add.reduceat(cells.is_corner.astype(int), cells.face_offsets[:-1])
    assert cells.is_whole.all() and (corners % 4 == 0).all()
    assert (corners - 4).sum() // 4 == -surface.euler_characteristic
    assert (np.diff(cells.simplified().face_offsets) == corners).all()
    assert cells.is_quad.sum() >= len(cells) + surface.euler_characteristic
    places = tiled(name).places()
    assert len(cells) == len(places) + surface.euler_characteristic  # the branch's tile has a middle for each turn


@pytest.mark.parametrize(("columns", "rows"), [(1, 1), (1, 4), (2, 2), (2, 5), (3, 1), (6, 7)])
def test_tori_of_few_tiles(columns, rows):
    on = grid_torus(12, 9, columns, rows)
    cells = on.cells()
    assert_same_topology(cells, on.surface)
    assert_same_topology(cells.simplified(), on.surface)
    assert cells.is_quad.all() == (columns > 1 and rows > 1)
    assert abs(polygon_areas(cells).sum() - columns * rows) < EXACT


@pytest.mark.parametrize("shift", [0, 1 / 8])
def test_lines_along_edges_and_through_vertices(shift):
    """The grid's own lines are those of tiles."""
    on = grid_torus(12, 8, 6, 4, shift=shift, jitter=0)
    cells = on.cells()
    assert_same_topology(cells, on.surface)
    assert_same_topology(cells.simplified(), on.surface)
    assert len(cells) == 24 and cells.is_quad.all()
    assert (np.diff(cells.simplified().face_offsets) == 4).all()


@pytest.mark.parametrize("shift", [(0, 0), (0.5, 0.5), (0.25, 0)])
def test_squares_with_a_boundary(shift):
    surface, uv = flat_square(shift)
    cells = TiledSurface(surface, uv).cells()
    assert_same_topology(cells, surface)
    assert_same_topology(cells.simplified(), surface)
    assert len(cells) == np.prod([4 if s == 0 else 5 for s in shift])
    assert abs(polygon_areas(cells).sum() - 16) < EXACT


BRICKS = {"per_tile": (2, 2), "shifted_rows": True}


@everywhere
def test_bricks_are_the_surface_too(name):
    cells = tiled(name).cells(**BRICKS)
    assert_same_topology(cells, tiled(name).surface)
    assert_same_topology(cells.simplified(), tiled(name).surface)
    areas = polygon_areas(cells)
    if not tiling(name).quality.flipped.any():
        assert np.abs(areas[cells.is_quad] - 1 / 4).max() < EXACT
    assert abs(areas[cells.poles < 0].sum() - area_outside_of_stars(tiled(name))) < 1e-7
    assert cells.is_quad.sum() > 2 * tiled(name).cells().is_quad.sum()


@pytest.mark.parametrize("options", [BRICKS, {"per_tile": (1, 4), "shifted_rows": True}, {"per_tile": (3, 2)}])
@pytest.mark.parametrize("name", ["torus without poles", "knot"])
def test_their_middles_are_places(name, options):
    cells, places = tiled(name).cells(**options), tiled(name).places(**options)
    assert len(cells) == len(places) and cells.is_quad.all()
    if "shifted_rows" in options:
        assert (np.diff(cells.simplified().face_offsets) == 6).all()  # four corners, and one above and below
    at = inside(cells, cells.uv)
    low, high = (bound.reduceat(at, cells.face_offsets[:-1]) for bound in (np.minimum, np.maximum))
    sizes = high - low
    assert np.abs(sizes - 1 / np.array(options["per_tile"])).max() < EXACT
    middles, own = ((each % 1).round(6) % 1 for each in ((low + high) / 2, inside(cells, places.uv)))
    assert {*map(tuple, middles)} == {*map(tuple, own)}
    assert (np.floor((low + high) / 2 + EXACT) == cells.tiles).all()


@pytest.mark.parametrize("seed", range(30))
def test_whatever_folds_they_fit(seed):
    """UVs far from what a map should be: a third of the triangles is flipped, some have collapsed onto lines."""
    on = folded_torus(seed)
    for options in ({}, BRICKS):
        cells = on.cells(**options)
        assert_same_topology(cells, on.surface)
        assert_same_topology(cells.simplified(), on.surface)
    area = area_outside_of_stars(on)
    assert abs(area - round(area)) < EXACT
    places = on.places(offset=(0.37, 0.41))
    assert len(places) - places.flipped == round(area)


def test_a_mirrored_map_has_them_too():
    on = tiled("torus without poles")
    mirrored = TiledSurface(on.surface, on.uv * [-1, 1])
    cells = mirrored.cells()
    assert_same_topology(cells, on.surface)
    assert cells.is_quad.all() and len(cells) == len(on.cells())
    assert len(mirrored.places()) == len(on.places())


def test_polygons_keep_their_orientation_in_single_precision():
    on = tiled("genus 2")
    single = TiledSurface(on.surface, on.uv.astype(np.float32), on.lattice).cells()
    assert len(single) == len(on.cells())
    assert_same_topology(single, on.surface)


def test_a_tile_with_holes_is_a_few_disks():
    surface = surface_of(families.punched(families.torus(24, 18, shape="triangles"), 3))
    i, j = np.divmod(np.arange(24 * 18), 18)
    at = np.stack([i / 12 + 0.01, j / 6 + 0.02], axis=1)
    cells = TiledSurface(surface, torus_uv(at, surface, 2, 3)).cells()
    assert_same_topology(cells, surface)
    assert 6 < len(cells) < 20 and not cells.is_whole.all()


@pytest.mark.parametrize("name", ["genus 5", "sphere", "handle and hole", "genus 2, hexagonal"])
def test_they_are_the_same_in_any_numbering(name):
    one, other = tiled(name).cells(), renumbered(tiled(name)).cells()
    assert len(one) == len(other) and one.is_quad.sum() == other.is_quad.sum()
    assert same_points(one.vertices, other.vertices, EXACT)
    assert (np.sort(np.diff(one.face_offsets)) == np.sort(np.diff(other.face_offsets))).all()


def test_no_thread_changes_a_bit():
    on = tiled("genus 5")
    one, two = (TiledSurface(on.surface, on.uv, on.lattice, threads=n).cells() for n in (1, 2))
    for attribute in ("corner_vertices", "face_offsets", "uv", "triangles", "barycentric"):
        assert (getattr(one, attribute) == getattr(two, attribute)).all()
