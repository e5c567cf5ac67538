"""Tilings whose sides of a cut may also turn: their jumps are symmetries of the texture, to the last bit."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Cancelled, Surface, TopologyError, automatic_map, automatic_structure
from holomorph.quality.quality import Quality
from limbed import bumps
from solved import surface_of
from turned_jumps import jump_errors

MESHES = {
    "sphere": lambda: families.geodesic_sphere(8),
    "quads": lambda: families.spun(24, 12),
    "torus": lambda: families.torus(30, 20, R=1.5),
    "block": lambda: families.block_with_holes(2, refine=3, jitter=0.2),
    "bowl": lambda: families.hemisphere(8),
    "tube": lambda: families.cylinder(16, 24),
    "torus with a hole": lambda: families.punctured_torus(24, 18),
}


@pytest.fixture(scope="module", params=MESHES)
def surface(request):
    return surface_of(MESHES[request.param]())


def tiling(surface, turns, tiles=300.0, **options):
    options = {"evenness": 0.5} | options
    return automatic_structure(surface).tile(tiles, turns=turns, **options)


def block_of_three_holes():
    return families.block_with_holes(3, refine=3, jitter=0.2)


def angles_around(surface, uv):
    """(#V,) in the map, in full turns."""
    at = (uv @ [1, 1j])[surface._native.triangle_corners]
    corners = np.angle((np.roll(at, 1, axis=1) - at) / (np.roll(at, -1, axis=1) - at))
    return np.bincount(surface.triangles.ravel(), corners.ravel()) / (2 * np.pi)


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_jumps_are_symmetries_of_the_texture(surface, turns):
    made = tiling(surface, turns)
    error = jump_errors(surface, made)
    assert error.max() == 0 if turns != 6 else error.max() < 1e-12
    single = made.uv.astype(np.float32)
    assert turns == 6 or np.array_equal(single, made.uv)


def test_many_triangles_are_evened_alike_on_any_number_of_threads():
    """So many that multigrid is chosen, which smaller meshes never see."""
    ball = surface_of(families.geodesic_sphere(28))
    one, three = (automatic_structure(ball, threads=n).tile(300.0, turns=4, evenness=0.5) for n in (1, 3))
    assert np.array_equal(one.uv, three.uv) and not one.quality.flipped.any()
    assert jump_errors(ball, one).max() == 0
    small = tiling(surface_of(families.geodesic_sphere(14)), 4)
    assert one.quality.size_range < 1.05 * small.quality.size_range


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_what_is_missing_around_cones_is_the_euler_number(surface, turns):
    made = tiling(surface, turns)
    missing = (1 - made.cone_angles) * turns
    assert np.allclose(missing, np.rint(missing), atol=1e-12)
    if surface.boundary_count == 0:
        assert round(missing.sum()) == turns * (2 - 2 * surface.genus)
    assert len(made.poles) == 0 and made.turns == turns


@pytest.mark.parametrize("turns", [2, 4, 6])
def test_it_is_more_even_than_what_may_only_be_shifted(turns):
    ball = surface_of(families.geodesic_sphere(10))
    shifted, turned = automatic_map(ball, main="seamless"), automatic_map(ball, main="seamless", turns=turns)
    assert turned.quality.size_range < shifted.quality.size_range
    assert turned.quality.mean_angle < shifted.quality.mean_angle and turned.cost < 0.8 * shifted.cost
    assert not turned.quality.flipped.any()
    assert 0 < turned.quality.unseen_angle <= shifted.quality.unseen_angle


@pytest.mark.parametrize("turns", [2, 4, 6])
@pytest.mark.parametrize(("mesh", "tiles"), [("bumps", 400), ("bumps", 50), ("block", 400), ("scaffold", 400)])
def test_cones_are_apart_and_nothing_is_flipped(turns, mesh, tiles):
    """By most of the distance between the centres of turns, since two that are nearer would lie at one of them."""
    meshes = {"bumps": bumps, "block": block_of_three_holes, "scaffold": lambda: families.scaffold(2)}
    surface = surface_of(meshes[mesh]())
    made = tiling(surface, turns, tiles=float(tiles))
    assert not made.quality.flipped.any()
    angle = np.ones(len(surface.vertices))
    angle[made.cones] = made.cone_angles
    assert np.allclose(angles_around(surface, made.uv), angle, atol=1e-6)
    points = surface.vertices[made.cones]
    between = np.linalg.norm(points[:, None] - points, axis=2)[np.triu_indices(len(points), 1)]
    centres = {2: 0.5, 4: np.sqrt(0.5), 6: np.sqrt(2 / np.sqrt(3))}[turns]
    assert between.min(initial=np.inf) > 0.69 * centres * np.sqrt(surface.area / tiles)


def test_a_poor_map_that_turns_gives_way_to_one_that_is_shifted():
    """On twenty faces: half turns cost 2.3 there, poles 0.06, and rows that are not level 0.5. Its jumps are symmetries
    of the texture, too."""
    made = automatic_map(surface_of(families.geodesic_sphere(1)), main="seamless", turns=2)
    assert made.kind == "tiling" and made.turns == 1 and made.cost < 0.6


@pytest.mark.parametrize(("radius", "turns"), [(4.0, 1), (1.5, 4)])
def test_the_best_map_of_an_even_ring_needs_no_cones(radius, turns):
    """Its rows all run round; on a thick ring squares would differ too much in size."""
    made = automatic_map(surface_of(families.torus(30, 20, R=radius)), turns=4)
    assert made.turns == turns and len(made.poles) == 0 and (len(made.cones) > 0) == (turns > 1)
    asked = automatic_map(surface_of(families.torus(30, 20, R=radius)), main="seamless", turns=4)
    assert asked.turns == 4


def test_a_flat_disk_and_a_straight_tube_have_no_cones():
    points, faces = families.hexagonal_disk(8)
    disk = Surface(np.column_stack([points, np.zeros(len(points))]), faces)
    for made in (tiling(disk, 4), tiling(surface_of(families.cylinder(16, 24)), 4, evenness=0.0)):
        assert len(made.cones) == 0 and made.quality.size_range == pytest.approx(1, abs=1e-3)


def test_a_cube_has_a_cone_at_each_corner():
    """As on dice: three squares meet there."""
    made = tiling(surface_of(families.cube()), 4, tiles=54.0, evenness=0.0)
    assert len(made.cones) == 8 and (made.cone_angles == 0.75).all()
    assert made.quality.size_range < 1.2


def test_without_turns_nothing_has_changed(surface):
    structure = automatic_structure(surface)
    assert np.array_equal(structure.tile(100, turns=1).uv, automatic_structure(surface).tile(100).uv)
    assert structure.tile(100).turns == 1 and structure.tile(100).jumps.shape == (0, 3)


def test_bits_do_not_depend_on_threads():
    ball = surface_of(families.geodesic_sphere(9))
    made = [automatic_map(ball, main="seamless", turns=4, threads=count).uv for count in (1, 2, 4)]
    assert np.array_equal(made[0], made[1]) and np.array_equal(made[0], made[2])


def test_about_as_many_tiles_have_the_same_cones():
    structure, stages = automatic_structure(surface_of(families.geodesic_sphere(6))), []
    first = structure.tile(100, turns=4, evenness=0.5)
    second = structure.tile(120, turns=4, evenness=0.5, progress=lambda _fraction, stage: stages.append(stage))
    assert np.array_equal(first.cones, second.cones) and stages and "cones" not in stages
    assert second.quality.median_density == pytest.approx(1.2 * first.quality.median_density, rel=0.35)


@pytest.mark.parametrize("turns", [2, 4, 6])
@pytest.mark.parametrize("mesh", [lambda: families.geodesic_sphere(12), bumps, block_of_three_holes])
def test_there_are_about_as_many_tiles_as_asked(turns, mesh):
    """Each number is that of the nearest whole jumps, which may be farther for one than for most."""
    surface = surface_of(mesh())
    found = [tiling(surface, turns, tiles).quality.median_density * surface.area / tiles for tiles in (330, 400, 480)]
    assert np.median(found) == pytest.approx(1, rel=0.15) and np.allclose(found, 1, atol=0.35)


@pytest.mark.parametrize("turns", [2, 4, 6])
@pytest.mark.parametrize(("direction", "unit"), [("upright", 1j), ((0.0, 0.0, 2.0), 1)])
def test_rows_run_as_asked(turns, direction, unit):
    """Level, or u along a vector, but for turns of the texture."""
    tube = surface_of(families.cylinder(16, 24))
    z = tiling(tube, turns, tiles=200.0, direction=direction).uv @ [1, 1j]
    heights = tube.vertices[tube.corner_vertices, 2]
    along = [(z * np.conj(unit * np.exp(2j * np.pi * r / turns))).real for r in range(turns)]
    assert max(np.corrcoef(heights, values)[0, 1] for values in along) > np.cos(
        np.radians(6)
    )  # which rounding may take


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"turns": 3}, "turns is 3; one of 1, 2, 4, 6"),
        ({"turns": 4.0}, "turns is 4.0; one of 1, 2, 4, 6"),
        ({"turns": [4]}, "turns is"),
        ({"turns": True}, "turns is True"),
        ({"turns": 4, "poles": 6}, "a tiling that turns has no choice of poles: take turns=1"),
        ({"turns": 4, "poles": np.array([3, 5])}, "has no choice of poles"),
        ({"turns": 4, "lattice": "brick"}, "lattice is 'brick'"),
        ({"turns": 4, "moves": {0: 1}}, "has no choice of moves of poles"),
        ({"turns": 4, "direction": "up"}, "direction is 'up'"),
        ({"turns": 4, "direction": (0, 0, 0)}, "not all 0"),
    ],
)
def test_wrong_choices_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        automatic_structure(surface_of(families.geodesic_sphere(3))).tile(**options)


@pytest.mark.parametrize("turns", [3, 4.0, [4], True, "4", None])
def test_an_automatic_map_names_wrong_turns(turns):
    with pytest.raises(ValueError, match="turns is .*; one of 1, 2, 4, 6 is needed"):
        automatic_map(surface_of(families.geodesic_sphere(3)), turns=turns)


def test_a_surface_without_positions_is_refused():
    torus = surface_of(families.torus(12, 8))
    points = torus.vertices[torus.triangles]
    lengths = np.linalg.norm(np.roll(points, -1, axis=1) - np.roll(points, -2, axis=1), axis=2)
    intrinsic = Surface.from_edge_lengths(torus.triangles, lengths)
    with pytest.raises(TopologyError, match="needs positions"):
        automatic_structure(intrinsic).tile(turns=4)


def test_a_surface_that_would_collapse_is_refused():
    """A tube longer by far than a tile is wide, with few tiles: no whole one fits around it."""
    tube = families.cylinder(4, 900)
    long = surface_of(replace(tube, vertices=tube.vertices * [1, 1, 300]))
    with pytest.raises(TopologyError, match="take more tiles, or turns=1"):
        tiling(long, 4, tiles=10.0)
    assert tiling(long, 4, tiles=4000.0).quality.lost_part < 0.01


def torus_with_a_doublet():
    """Quads, one of them cut in two along a bent line, so that two triangles have the same vertices."""
    mesh = families.torus(90, 60)
    *quads, (a, b, c, d) = mesh.faces
    bend = len(mesh.vertices)
    vertices = np.vstack([mesh.vertices, 1.03 * mesh.vertices[a] - 0.03 * mesh.vertices[c]])
    return families.polygons(vertices, [*quads, [a, b, c, bend], [a, bend, c, d]])


def test_cones_are_searched_for_on_levels_where_triangles_have_the_same_vertices():
    """The search on all triangles of a model of 64,000 took three minutes."""
    stages = []
    structure = automatic_structure(surface_of(torus_with_a_doublet()))
    structure.tile(turns=4, progress=lambda _fraction, stage: stages.append(stage))
    assert "edge collapses" in stages


def test_it_can_be_cancelled():
    ball = surface_of(families.geodesic_sphere(12))
    with pytest.raises(Cancelled):
        automatic_structure(ball).tile(turns=4, progress=lambda _fraction, stage: stage != "cones")


def test_the_hexagons_of_a_ball():
    """Twelve cones of five sixths, as on a football."""
    made = tiling(surface_of(families.geodesic_sphere(6)), 6, tiles=200.0)
    assert ((1 - made.cone_angles) * 6).sum() == pytest.approx(12)
    found = Quality.of(surface_of(families.geodesic_sphere(6))._native, made.uv, 1)
    assert not found.flipped.any() and len(made.cones) == 12
    named = tiling(surface_of(families.geodesic_sphere(6)), 6, tiles=200.0, lattice="hex")
    assert np.array_equal(named.uv, made.uv)


@pytest.mark.parametrize("tiles", [12.0, 300.0])
@pytest.mark.parametrize("turns", [2, 4, 6])
def test_added_distortion_counts_angles_and_flips(tiles, turns):
    """The singular values of the map before it is evened tell them."""
    block = surface_of(block_of_three_holes())
    made = tiling(block, turns, tiles, evenness=0.0)
    is_lost = made.quality.flipped | made.quality.collapsed
    angle = np.where(is_lost, 10, np.minimum(made.quality.angle, 10))
    beltrami = np.where(is_lost, 1, 1 - 2 / (np.where(is_lost, 1, made.quality.angle) + 1))
    weights = made.quality.weights / made.quality.weights.sum()
    assert made.added_distortion == pytest.approx(weights @ angle) and made.added_distortion > 1.001
    assert made.beltrami_rms == pytest.approx(np.sqrt(weights @ beltrami**2))
    evened = tiling(block, turns, tiles)
    assert evened.added_distortion == pytest.approx(made.added_distortion, rel=0.5)
    with pytest.raises(TopologyError, match="more than max_added, 1: take more tiles"):
        tiling(block, turns, tiles, max_added=1.0)
