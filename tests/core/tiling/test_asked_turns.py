"""What is asked for of maps that turn, the turns of a texture and lines; and what is told of them at each door."""

import json
import math

import families
import numpy as np
import pytest
from drawn_images import checker, hexagons
from holomorph import InvalidMesh, Surface, automatic_map, automatic_maps, automatic_structure
from holomorph.maps.report import part_report
from holomorph.mesh.edges import edge_keys
from holomorph.quality.appearance import CONE, cost
from holomorph.quality.verdicts import Seen, special, verdict
from measured import Measured
from solids import revolved
from solved import surface_of

TEXTURES = {
    "checker": (checker(64, 4), 4),
    "boards": (np.kron(checker(32, 4), np.ones((1, 2)))[:, :32], 2),
    "hexagons": (hexagons(222, 128, 2, 1), 6),
    "one way": (checker(64, 4) * np.linspace(0, 1, 64), 1),
}
CUP = ((0, 0), (0.5, 0), (0.5, 1), (0.42, 1), (0.42, 0.08), (0, 0.08))


def ball():
    return surface_of(families.geodesic_sphere(6))


def box():
    return surface_of(families.voxel_surface(np.ones((4, 4, 4)), ((0, 0),)))


def dome():
    """A bowl upside down on a plate: the bowl has a tiling of its own, and rows run round the plate's rim."""
    arc = [(0.4 * math.cos(angle), 0.2 + 0.4 * math.sin(angle)) for angle in np.linspace(0.2, 1.4, 6)]
    return revolved((0, 0), (0.5, 0), (0.5, 0.2), (0.4, 0.2), *arc, (0, 0.6))


@pytest.mark.parametrize("name", TEXTURES)
def test_auto_takes_the_turns_of_the_texture(name):
    pixels, turns = TEXTURES[name]
    structure, options = automatic_structure(ball()), {"evenness": 0.5}
    made = structure.tile(200, turns="auto", texture=pixels, **options)
    assert made.turns == turns
    assert np.array_equal(made.uv, structure.tile(200, turns=turns, **options).uv)
    one = automatic_map(ball(), main="seamless", turns="auto", texture=pixels)
    (other,) = automatic_maps(ball(), main="seamless", turns=turns)
    assert one.turns == turns and one.tiling.tiles == other.tiling.tiles


def test_without_a_texture_auto_is_none():
    structure = automatic_structure(ball())
    assert np.array_equal(structure.tile(100, turns="auto").uv, structure.tile(100).uv)
    (made,) = automatic_maps(ball(), main="seamless", turns="auto")
    assert made.turns == 1 and np.array_equal(made.uv, automatic_map(ball(), main="seamless").uv)


@pytest.mark.parametrize("lines", ["none", "free", "whole"])
def test_lines_are_those_that_are_asked_for(lines):
    """Whatever they cost; and so are all that are asked for of a mesh without any."""
    cup = revolved(*CUP)
    made = automatic_map(cup, main="seamless", turns=4, lines=lines)
    assert made.tiling.lines == lines
    assert automatic_map(cup, main="seamless", turns=4).tiling.lines == "free"
    one = automatic_map(ball(), main="seamless", turns=4, lines=lines)
    assert one.tiling.lines == "none" and np.array_equal(one.uv, automatic_map(ball(), main="seamless", turns=4).uv)


def test_lines_that_cannot_be_made_are_left_out():
    """Half turns do not fit the lines of a box, which meet at right angles."""
    made = automatic_map(box(), main="seamless", turns=2, lines="whole")
    assert made.tiling.lines in ("none", "whole") and made.quality.lost_part < 0.02


@pytest.mark.parametrize("make", [automatic_map, automatic_maps])
@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"turns": "texture"}, "turns is 'texture'; one of 1, 2, 4, 6 is needed"),
        ({"turns": 4, "lines": "all"}, "lines is 'all'; one of automatic, none, whole, free, mirror is needed"),
        ({"turns": 6, "lines": "free"}, "lines is 'free', for which turns must be 2 or 4"),
        ({"turns": "auto", "lines": "whole"}, "lines is 'whole', for which turns must be 2 or 4"),
        ({"turns": "auto", "texture": np.zeros(3)}, "pixels have the shape"),
    ],
)
def test_wrong_choices_are_named(make, options, words):
    with pytest.raises(ValueError, match=words):
        make(ball(), **options)


@pytest.mark.parametrize("turns", [2, 4])
def test_maps_in_pieces_have_the_cones_of_their_tilings(turns):
    """Named as vertices of the whole surface, where the angles are those that are told."""
    surface = dome()
    made = automatic_map(surface, turns=turns)
    assert made.kind == "mixed" and made.turns == turns and len(made.cones) == len(made.cone_angles) > 0
    at = (made.uv @ [1, 1j])[surface._native.triangle_corners]
    corners = np.angle((np.roll(at, 1, axis=1) - at) / (np.roll(at, -1, axis=1) - at))
    around = np.bincount(surface.triangles.ravel(), corners.ravel()) / (2 * np.pi)
    assert np.allclose(around[made.cones], made.cone_angles, atol=1e-6)
    seams = [tiling.seams for tiling in made.tilings if tiling.turns != 1]
    assert len(np.concatenate(seams)) == len(made.jumps)
    count = len(surface.vertices)
    assert np.isin(edge_keys(np.concatenate(seams), count), edge_keys(made.seams, count)).all()
    assert (made.jumps[:, 0] < turns).all() and made.jumps[:, 0].any()


def test_the_cones_of_a_map_in_pieces_cost():
    made = automatic_map(dome(), turns=4)
    without = cost(made.quality, 0, made.soft_length, made.hard_length)
    assert made.cost == pytest.approx(without + CONE * len(made.cones))


def test_turns_cones_and_lines_are_told():
    assert special(None) is None and special(0) == "no poles" and special(1) == "1 pole"
    assert special(0, 4, 0, "none") == "quarter turns, no cones"
    told = "Even, seamless, half turns, 1 cone, rows run along edges"
    assert verdict(Measured(), Seen(poles=0, seams=0.0, turns=2, cones=1, lines="free")).sentence == told
    cube = automatic_map(box(), main="seamless", turns=4)
    words = "quarter turns, 8 cones, rows end at edges"
    assert words in cube.verdict.sentence and words in repr(cube.tiling)
    tiling = json.loads(json.dumps(part_report(cube)))["tiling"]
    assert (tiling["turns"], tiling["lines"], len(tiling["cones"])) == (4, "whole", 8)


def equator(surface):
    """(n, 2) vertices of the edges at half height."""
    edges = np.asarray(surface._native.edges)
    return edges[(np.abs(surface.vertices[edges][..., 2]) < 1e-9).all(axis=1)]


def run_along(surface, uv, marked):
    """(n,) whether a coordinate is one at both ends of each side of a triangle along these edges."""
    following = np.roll(surface.triangles, -1, axis=1)
    sides = np.stack([surface.triangles, following], axis=-1).reshape(-1, 2)
    count = len(surface.vertices)
    is_marked = np.isin(edge_keys(sides, count), edge_keys(marked, count))
    ends = np.stack([surface.triangle_corners, np.roll(surface.triangle_corners, -1, axis=1)], axis=-1).reshape(-1, 2)
    at = uv[ends[is_marked]]
    return (at[:, 0] == at[:, 1]).any(axis=1)


@pytest.mark.parametrize("lines", ["free", "whole"])
def test_marked_edges_are_lines(lines):
    """On a surface, and on the parts of a mesh whose vertices they name."""
    one = surface_of(families.geodesic_sphere(8))
    marked = equator(one)
    assert len(marked) > 10
    made = automatic_map(one, main="seamless", turns=4, lines=lines, marked=marked)
    assert made.tiling.lines == lines and run_along(one, made.uv, marked).all()
    tiling = automatic_structure(one).tile(200, turns=4, lines=lines, marked=marked, evenness=0.5)
    assert tiling.lines == lines and run_along(one, tiling.uv, marked).all()
    count = len(one.vertices)
    both = Surface(
        np.vstack([one.vertices + [3, 0, 0], one.vertices]), np.vstack([one.triangles, one.triangles + count])
    )
    options = {"main": "seamless", "tiles": 800, "turns": 4, "lines": lines}
    for part in automatic_maps(both, marked=np.vstack([marked, marked + count]), **options):
        assert part.tiling.lines == lines and run_along(part.surface, part.uv, marked).all()
    assert automatic_maps(both, marked=marked + count, **options)[0].tiling.lines == "none"


def test_marked_edges_that_cost_little_are_lines_by_themselves():
    """A ring of a tube, not one across it that ends here and there."""
    tube = surface_of(families.cylinder(16, 24))
    rings = np.unique(np.round(tube.vertices[:, 2], 9))
    edges = np.asarray(tube._native.edges)
    ring = edges[(np.abs(tube.vertices[edges][..., 2] - rings[5]) < 1e-6).all(axis=1)]
    made = automatic_map(tube, main="seamless", turns=4, marked=ring)
    assert made.tiling.lines == "whole" and run_along(tube, made.uv, ring).all()
    slanted = edges[~np.isin(edge_keys(edges, len(tube.vertices)), edge_keys(ring, len(tube.vertices)))][::9]
    other = automatic_map(tube, main="seamless", turns=4, marked=slanted)
    assert np.array_equal(other.uv, automatic_map(tube, main="seamless", turns=4).uv)


def test_marked_edges_of_pieces():
    """On a dome, that a map in pieces gives a tiling of its own."""
    surface = dome()
    edges = np.asarray(surface._native.edges)
    heights = surface.vertices[edges][..., 2]
    level = np.unique(np.round(heights[heights > 0.4], 9))[0]
    ring = edges[(np.abs(heights - level) < 1e-6).all(axis=1)]
    made = automatic_map(surface, turns=4, lines="free", marked=ring)
    assert made.kind == "mixed" and "free" in [tiling.lines for tiling in made.tilings]
    assert run_along(surface, made.uv, ring).all()


def test_marks_on_all_edges_are_no_lines():
    """So files come that are shaded flat."""
    for mesh in (families.geodesic_sphere(8), families.torus(24, 16)):
        surface = surface_of(mesh)
        made = automatic_map(surface, main="seamless", turns=4, lines="free", marked=surface._native.edges)
        assert made.tiling.lines == "none" and made.quality.lost_part == 0


@pytest.mark.parametrize("marked", [[1, 2], [[0.5, 1.0]], [["a", "b"]]])
def test_marked_edges_are_pairs_of_vertices(marked):
    with pytest.raises(InvalidMesh, match="marked"):
        automatic_maps(ball(), turns=4, marked=marked)
    with pytest.raises(InvalidMesh, match="marked"):
        automatic_structure(ball()).tile(turns=4, lines="free", marked=marked)


@pytest.mark.parametrize("scale", [0.5, 0.6, 0.7, 0.8, 0.9])
@pytest.mark.parametrize("lines", ["automatic", "whole"])
def test_parts_have_one_size(scale, lines):
    """Whether a map that turns has it, one without lines, or only one that is shifted: all are seamless. Tiles that
    turn may miss it by a fifth where those that are shifted cost more by as much."""
    one = surface_of(families.geodesic_sphere(8))
    marked, count = equator(one), len(one.vertices)
    points = np.vstack([one.vertices + [3, 0, 0], scale * one.vertices])
    both = Surface(points, np.vstack([one.triangles, one.triangles + count]))
    first, second = automatic_maps(both, main="seamless", turns=4, lines=lines, marked=marked + count)
    assert first.kind == second.kind == "tiling"
    ratio = max(first.density, second.density) / min(first.density, second.density)
    if second.turns == 4 and ratio >= 1.1:
        area = second.density * second.surface.area
        shifted = automatic_map(second.surface, main="seamless", turns=1, tiles=area / ratio)
        assert ratio < 1.2 and second.cost + np.log(ratio) < shifted.cost
    else:
        assert ratio < 1.1


@pytest.mark.parametrize(
    "marked", [5, "x", [[0.5, 1]], [[None, 1]], [[0, 2**63]], [[0, 1, 2]], np.array([[0, 1]], bool)]
)
def test_one_surface_refuses_wrong_marks_as_a_mesh_does(marked):
    for make in (automatic_map, automatic_maps):
        with pytest.raises(InvalidMesh, match="marked"):
            make(ball(), turns=4, marked=marked)


def test_marks_beyond_the_vertices_are_ignored():
    """Though their pair of numbers is that of an edge, counted through."""
    surface = ball()
    low, high = (int(v) for v in surface._native.edges[40])
    aliased = [[0, low * surface._native.vertex_count + high], [-1, high]]
    assert automatic_structure(surface).tile(turns=4, lines="free", marked=aliased).lines == "none"
    assert automatic_map(surface, main="seamless", turns=4, lines="free", marked=aliased).tiling.lines == "none"
    marked = [[low, high]]
    assert automatic_structure(surface).tile(turns=4, lines="free", marked=marked).lines == "free"


def test_tiles_of_a_turned_map_are_one_number():
    with pytest.raises(ValueError, match="tiles is \\[4\\]; a positive number is needed"):
        automatic_structure(ball()).tile([4], turns=4)
