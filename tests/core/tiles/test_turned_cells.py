"""Cells and reliefs of tilings that turn: quads whose irregular vertices are the cones, and surfaces that close up."""

from fractions import Fraction

import families
import numpy as np
import pytest
from cell_checks import assert_same_topology, polygon_areas
from holomorph import Surface, TiledSurface, automatic_map
from holomorph.mesh.edges import following_corners
from solved import surface_of
from turned_surfaces import MADE, SHAPES, angles, box, signed_area, tiled

SQUARES = {"ball": MADE["ball"], "torus": MADE["torus"], "bowl": families.hemisphere(10)}
BRICKS = {"per_tile": (2, 2), "shifted_rows": True}


@pytest.fixture(scope="module", params=[(name, turns) for name in SQUARES for turns in (2, 4)])
def made(request):
    name, turns = request.param
    return automatic_map(surface_of(SQUARES[name]), main="seamless", turns=turns)


def sides(cells):
    return np.diff(cells.simplified().face_offsets)


def valences(cells):
    """((#V,) edges at each vertex of the simplified cells, (#V,) whether it lies inside)."""
    ends = np.stack([cells.corner_vertices, cells.corner_vertices[following_corners(cells)]], axis=1)
    found, count = np.unique(np.sort(ends, axis=1), axis=0, return_counts=True)
    edges = np.bincount(found.ravel(), minlength=len(cells.vertices))
    return edges, ~np.isin(np.arange(len(cells.vertices)), found[count == 1])


@pytest.mark.parametrize("options", [{}, {"per_tile": (2, 2)}, {"per_tile": (3, 3)}])
def test_they_are_the_surface(made, options):
    cells = made.tiled.cells(**options)
    assert cells.is_whole.all() or made.surface.boundary_count
    assert_same_topology(cells, made.surface)
    assert_same_topology(cells.simplified(), made.surface)


def test_half_tiles_are_quads_and_cones_alone_irregular(made):
    """All centres of turns lie at corners of half tiles. Around a cone there are as many quads as its angle has right
    ones."""
    simple = made.tiled.cells((2, 2)).simplified()
    edges, is_inside = valences(simple)
    touches = np.logical_or.reduceat(~is_inside[simple.corner_vertices], simple.face_offsets[:-1])
    assert (np.diff(simple.face_offsets)[~touches] == 4).all() and simple.is_quad[~touches].all()
    angle = np.ones(len(made.surface.vertices))
    angle[made.cones] = made.cone_angles
    at_vertex = simple.barycentric.max(axis=1) == 1
    vertex = made.surface.triangles[simple.triangles, np.argmax(simple.barycentric, axis=1)]
    expected = np.where(at_vertex, 4 * angle[vertex], 4)
    assert (edges == np.rint(expected))[is_inside].all()
    inner = np.isin(made.cones, vertex[at_vertex & is_inside])
    assert inner.all() or made.surface.boundary_count


def test_whole_tiles_about_cones_have_as_many_sides_as_the_angle(made):
    """Those with a cone in the middle of a quarter-turn map."""
    if made.turns != 4 or made.surface.boundary_count:
        return
    cells = made.tiled.cells()
    edges, _ = valences(cells.simplified())
    irregular = np.concatenate([sides(cells)[sides(cells) != 4], edges[edges != 4]])
    assert sorted(irregular) == sorted(np.rint(4 * made.cone_angles).astype(int))


@pytest.mark.parametrize("per_tile", [1, 2, 3])
def test_they_have_the_area_of_the_map(made, per_tile):
    """A tile with a cone in its middle lies in the plane in no one way: it is left out."""
    cells = made.tiled.cells((per_tile, per_tile))
    areas = polygon_areas(cells)[cells.is_quad]
    assert np.abs(areas - Fraction(1, per_tile**2)).max() < 1e-9
    parts = {2: Fraction(1, 2), 4: Fraction(1, 4)}[made.turns]
    whole = signed_area(made.tiled) * per_tile**2
    if not made.surface.boundary_count:
        assert whole / parts == pytest.approx(round(whole / parts))


def test_uvs_of_a_cell_are_those_of_its_places_turned(made):
    cells, surface = made.tiled.cells(), made.surface
    corners = surface.triangle_corners[cells.triangles]
    at = np.einsum("ni,nij->nj", cells.barycentric, made.uv[corners])[cells.corner_vertices] @ [1, 1j]
    jumps = [cells.uv @ [1, 1j] - 1j**r * at for r in range(4)[:: 4 // made.turns]]
    off = [np.maximum(*(np.abs(part - np.rint(part)) for part in (jump.real, jump.imag))) for jump in jumps]
    assert np.min(off, axis=0).max() < 1e-9


def test_bricks_need_half_turns():
    """Their middles are places; those at cones are half ones."""
    on = automatic_map(surface_of(MADE["ball"]), main="seamless", turns=2).tiled
    cells, places = on.cells(**BRICKS), on.places((2, 2), (0.25, 0.5), True)
    assert_same_topology(cells, on.surface)
    assert_same_topology(cells.simplified(), on.surface)
    assert len(cells) == len(places) and cells.is_quad.mean() > 0.9
    assert np.abs(polygon_areas(cells)[cells.is_quad] - 1 / 4).max() < 1e-9
    low, high = (bound.reduceat(cells.uv, cells.face_offsets[:-1])[cells.is_quad] for bound in (np.minimum, np.maximum))
    assert (np.floor((low + high) / 2 + 1e-9) == cells.tiles[cells.is_quad]).all()
    own = {tuple(uv) for uv in (places.uv % 1).round(6) % 1}
    assert {tuple(uv) for uv in (((low + high) / 2) % 1).round(6) % 1} <= own
    for options in (BRICKS, {"per_tile": (2, 3)}):
        with pytest.raises(ValueError, match="cells of a tiling with quarter turns have as many columns as rows"):
            tiled("cube", 2).cells(**options)


@pytest.mark.parametrize("shift", [0.0, 0.5])
@pytest.mark.parametrize("tiles", [2, 3])
def test_dice(tiles, shift):
    """With lines along the edges six faces of whole tiles; with lines between them a triangle at each corner."""
    cells = tiled("cube", tiles, shift).cells()
    count = 6 * tiles**2 if shift == 0 else 6 * tiles**2 + 2
    assert len(cells) == count
    assert sorted(sides(cells)) == [3] * (0 if shift == 0 else 8) + [4] * (count - (0 if shift == 0 else 8))


@pytest.mark.parametrize(("shape", "shift"), [(shape, shift) for shape in SHAPES for shift in (0.0, 0.5)])
def test_no_thread_changes_a_bit(shape, shift):
    surface, uv = box(shape, 3, shift)
    one, two = (TiledSurface(surface, uv, turns=SHAPES[shape][0], threads=threads).cells((2, 2)) for threads in (1, 2))
    for attribute in ("corner_vertices", "face_offsets", "uv", "triangles", "barycentric"):
        assert np.array_equal(getattr(one, attribute), getattr(two, attribute))


def heights(turns, size=16):
    """Heights that are alike after these turns about the middle, and after no others."""
    y, x = (np.mgrid[:size, :size] + 0.5) / size * 2 * np.pi
    waves = {2: np.cos(2 * x) + np.cos(x + 2 * y), 4: np.cos(x + 2 * y) + np.cos(2 * x - y)}[turns]
    return (waves + 2) / 4


def test_a_relief_closes_up_and_has_the_heights_of_its_tiles(made):
    """Across turned sides as well: the height of a vertex is that of the picture at all its corners."""
    picture = heights(made.turns)
    raised = made.tiled.relief(picture, 0.05, tolerance=0.05, most_triangles=30000)
    again = Surface(raised.vertices, raised.triangles)
    assert again.euler_characteristic == made.surface.euler_characteristic
    assert again.boundary_count == made.surface.boundary_count
    x, y = (raised.uv.T * 2 * np.pi)[..., None]
    expected = {2: np.cos(2 * x) + np.cos(x - 2 * y), 4: np.cos(x - 2 * y) + np.cos(2 * x + y)}[made.turns][:, 0]
    off = np.abs(raised.heights[raised.triangles.ravel()] - (expected + 2) / 4)
    assert off.max() < 0.1  # of the bilinear picture


def test_heights_that_do_not_turn_are_refused(made):
    on = made.tiled
    slope = np.broadcast_to(np.linspace(0, 1, 8), (8, 8))
    with pytest.raises(
        ValueError,
        match="the heights do not look the same after .* turns about the middle.*: make the map without turns",
    ):
        on.relief(slope, 0.05)
    if made.turns == 4:
        with pytest.raises(ValueError, match="8 x 4 pixels cannot turn by a quarter: a square is needed"):
            on.relief(slope[:4], 0.05)


def test_angles_of_the_boxes():
    """What the tests above rely on: cones of a cube and of a pillow."""
    for shape, angle, count in (("cube", 0.75, 8), ("pillow", 0.5, 4)):
        found = angles(tiled(shape, 2))
        assert np.count_nonzero(np.abs(found - angle) < 1e-9) == count
