"""Seamless tilings: jumps on the lattice (exact), holomorphic (solver), even density (discretisation)."""

import families
import holomorph
import numpy as np
import pytest
from holomorph import Cancelled, InvalidMesh, Tiler, TopologyError, automatic_structure, place_poles
from solved import surface_of
from tiled_families import CASES, DISK, DOUBLE, EXACT, SPHERE, TORUS, jumps, tiling

everywhere = pytest.mark.parametrize("name", CASES)


def basis(options):
    a, b = holomorph.tiling.request.LATTICES[options.get("lattice", "square")]
    return np.array([[a.real, complex(b).real], [complex(a).imag, complex(b).imag]])


@everywhere
def test_jumps_are_on_the_lattice(name):
    mesh, options = CASES[name]
    made = tiling(name)
    difference = jumps(mesh, made.uv, made.poles)
    assert len(difference) > 100
    assert np.abs(difference[:, 0] - difference[:, 1]).max() < EXACT * np.abs(made.uv).max()
    steps = np.linalg.solve(basis(options), difference[:, 0].T)
    assert np.abs(steps - np.rint(steps)).max() < 10 * EXACT * np.abs(made.uv).max()
    assert np.abs(np.rint(steps)).max() >= 1


@pytest.mark.parametrize("name", [n for n in CASES if "lattice" not in CASES[n][1]])
def test_single_precision_keeps_whole_jumps(name):
    mesh, _ = CASES[name]
    made = tiling(name)
    difference = jumps(mesh, made.uv.astype(np.float32), made.poles)
    assert np.array_equal(difference, np.rint(difference))


@everywhere
def test_residues_are_on_the_lattice_and_sum_to_zero(name):
    mesh, options = CASES[name]
    made = tiling(name)
    parts = np.stack([made.residues.real, made.residues.imag])
    steps = np.linalg.solve(basis(options), parts)
    assert np.abs(steps - np.rint(steps)).max(initial=0) < EXACT
    if mesh.boundary_count == 0:
        assert abs(made.residues.sum()) < EXACT
    assert made.periods.shape == (2 * mesh.genus + max(0, mesh.boundary_count - 1), 2)


@pytest.mark.parametrize(("mesh", "poles"), [(SPHERE, 2), (SPHERE, 3), (DOUBLE, 0)])
def test_zeros_and_poles_count_the_genus(mesh, poles):
    """Where no zero lies in the star of a pole: poles are often beside zeros, and even the density there."""
    made = automatic_structure(surface_of(mesh)).tile(256, poles=poles)
    assert len(made.poles) == poles
    assert made.zeros[1].sum() - len(made.poles) == 2 * mesh.genus - 2


@pytest.mark.parametrize("name", ["sphere", "sphere, brick", "holes, straight", "holes, free", "disk"])
def test_planar_surfaces_are_conformal_exactly(name):
    assert tiling(name).added_distortion == 1
    assert tiling(name).beltrami_rms == 0


def test_moving_poles_leave_nothing_over():
    structure = automatic_structure(surface_of(families.torus(48, 36, shape="triangles", jitter=0.3)))
    without = structure.tile(60, poles=0)
    assert without.added_distortion > 1.001
    with_poles = structure.tile(60, poles=6)
    assert with_poles.added_distortion < 1.0005
    assert with_poles.beltrami_rms < 1e-2 * without.beltrami_rms + 1e-3


def test_poles_make_the_density_even():
    capsule = families.moved(families.geodesic_sphere(14, jitter=0.1), scale=1.0)
    stretched = families.replace(capsule, vertices=capsule.vertices * [1, 1, 5])
    structure = automatic_structure(surface_of(stretched))
    two, eight = structure.tile(100, poles=2), structure.tile(100, poles=8)
    assert eight.optimal_size_range < two.optimal_size_range
    assert eight.size_range < 1.22 * eight.optimal_size_range


def test_tiles_are_counted_at_the_median_density():
    surface = surface_of(SPHERE)
    made = automatic_structure(surface).tile(density=60 / surface.area, poles=4)
    assert made.tiles == pytest.approx(60)
    # The rounding may change lengths by 12 %, and the residues besides.
    assert made.quality.median_density * surface.area == pytest.approx(60, rel=0.4)


def shares_along(tiling, mesh, axis):
    """Mean squares of u and v along an axis that is projected to the triangles."""
    points, uv = mesh.vertices[np.asarray(mesh.corners).reshape(-1, 3)], tiling.uv.reshape(-1, 3, 2)
    sides, images = (np.swapaxes(values[:, 1:] - values[:, :1], 1, 2) for values in (points, uv))
    return np.mean((images @ (np.linalg.pinv(sides) @ axis)[..., None]) ** 2, axis=0).ravel()


def test_direction_turns_the_texture():
    """On a thin ring, along its axis and across it; turned by a right angle, v does."""
    ring = families.torus(60, 12, R=3.0, r=0.3, shape="triangles")
    structure = automatic_structure(surface_of(ring))
    axis = np.eye(3)[np.argmin(np.ptp(ring.vertices, axis=0))]
    for direction, turn in ((axis, None), (axis, np.pi / 2), (axis[[1, 2, 0]], None)):
        along_u, along_v = shares_along(structure.tile(400, poles=0, direction=direction, turn=turn), ring, direction)
        assert along_v > 1.5 * along_u if turn else along_u > 1.5 * along_v, (direction, along_u, along_v)
    with pytest.raises(ValueError, match="direction is"):
        structure.tile(direction=[0, 0, 0])


def test_a_direction_normal_to_a_plane_is_none():
    angle, radius = np.meshgrid(2 * np.pi * np.arange(24) / 24, [1.0, 1.4, 2.0, 2.7], indexing="ij")
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(24), np.arange(3), indexing="ij")
    following = (i + 1) % 24
    quads = np.stack([4 * i + j, 4 * i + j + 1, 4 * following + j + 1, 4 * following + j], axis=-1).reshape(-1, 4)
    flat = automatic_structure(holomorph.Surface(points, quads))
    free = {"tiles": 60, "poles": 0, "boundary": "free"}
    assert np.array_equal(flat.tile(direction=(0, 0, 1), **free).uv, flat.tile(**free).uv)


def test_chosen_poles_stay():
    made = automatic_structure(surface_of(SPHERE)).tile(40, poles=[3, 100, 400])
    assert set(made.poles) <= {3, 100, 400}
    assert len(made.poles) >= 2


def test_poles_keep_to_where_they_are_allowed():
    surface = surface_of(SPHERE)
    allowed = surface.vertices[:, 2] > 0
    found = place_poles(surface, 4, allowed=allowed)
    assert allowed[found.vertices].all()
    torus = surface_of(TORUS)
    outside = np.linalg.norm(torus.vertices[:, :2], axis=1) > 2
    assert outside[Tiler(torus, 4, allowed=outside).tile(60).poles].all()
    with pytest.raises(ValueError, match="allowed has the shape"):
        place_poles(surface, 4, allowed=allowed[:-1])
    with pytest.raises(ValueError, match="no vertex"):
        place_poles(surface, 4, allowed=np.zeros_like(allowed))


@pytest.mark.parametrize("name", ["sphere", "genus 2", "holes, straight"])
def test_same_bits_at_any_number_of_threads(name):
    mesh, options = CASES[name]
    options = dict(options)
    tiles, poles = options.pop("tiles"), options.pop("poles")
    made = [Tiler(surface_of(mesh), poles, threads=threads).tile(tiles) for threads in (1, 2, 4)]
    for other in made[1:]:
        assert np.array_equal(made[0].uv, other.uv)
        assert np.array_equal(made[0].poles, other.poles)


def test_large_surfaces_find_their_poles_on_a_level():
    surface = surface_of(families.torus(150, 50, shape="triangles", jitter=0.2))
    assert len(surface.triangles) > 10_000
    made = automatic_structure(surface).tile(64, poles=4)
    assert made.added_distortion < 1.001
    assert made.size_range < 1.41 * made.optimal_size_range


REFUSED = [
    (SPHERE, {"poles": 1}, TopologyError, "two or more"),
    (SPHERE, {"poles": 0}, TopologyError, "not enough"),
    (SPHERE, {"poles": [5]}, TopologyError, "two or more"),
    (SPHERE, {"poles": [5, 5]}, TopologyError, "pole 5 is given twice"),
    (SPHERE, {"poles": [5, 10**6]}, TopologyError, "1000000 is not a vertex"),
    (SPHERE, {"poles": 500}, TopologyError, "room for"),
    (SPHERE, {"poles": "many"}, ValueError, "poles is 'many'"),
    (SPHERE, {"poles": 2.5}, ValueError, "whole number"),
    (SPHERE, {"lattice": [[1, 2], [2, 4]]}, ValueError, "singular"),
    (SPHERE, {"lattice": "round"}, ValueError, "lattice is 'round'"),
    (SPHERE, {"lattice": np.eye(3)}, ValueError, "2 x 2"),
    (SPHERE, {"poles": np.nan}, ValueError, "whole number"),
    (SPHERE, {"poles": None}, InvalidMesh, "poles"),
    (SPHERE, {"poles": [[1], [2, 3]]}, InvalidMesh, "poles"),
    (SPHERE, {"tiles": -1}, ValueError, "positive"),
    (SPHERE, {"tiles": "many"}, ValueError, "tiles is 'many'"),
    (SPHERE, {"density": "high"}, ValueError, "density is 'high'"),
    (SPHERE, {"turn": np.nan}, ValueError, "turn is nan"),
    (SPHERE, {"max_turn": None}, ValueError, "max_turn is None"),
    (SPHERE, {"direction": "up"}, ValueError, "direction is"),
    (SPHERE, {"lattice": [["a", 1], [0, 1]]}, ValueError, "lattice is"),
    (SPHERE, {"boundary": ["free"]}, ValueError, "boundary is"),
    (SPHERE, {"tiles": 3, "density": 1}, ValueError, "not both"),
    (SPHERE, {"boundary": "round"}, ValueError, "boundary is 'round'"),
    (DOUBLE, {"tiles": 0.01, "poles": 0}, TopologyError, "are enough"),
    (DISK, {"poles": [len(DISK.vertices) - 1]}, TopologyError, "boundary"),
    (DOUBLE, {"tiles": 32, "poles": 0, "max_added": 1.0}, TopologyError, "take 2 poles or more, or more tiles"),
    (DOUBLE, {"tiles": 32, "poles": 8, "max_added": 1.0}, TopologyError, "max_added, 1: take more tiles"),
    (SPHERE, {"max_added": 0.9}, ValueError, "at least 1"),
    (SPHERE, {"max_added": np.nan}, ValueError, "max_added is nan"),
]


@pytest.mark.parametrize("mesh, options, error, message", REFUSED)
def test_refused(mesh, options, error, message):
    with pytest.raises(error, match=message):
        automatic_structure(surface_of(mesh)).tile(**options)


def test_an_intrinsic_surface_knows_no_direction():
    torus = automatic_structure(surface_of(families.flat_torus(0.3 + 1.1j, 6)))
    with pytest.raises(InvalidMesh, match="no direction in space"):
        torus.tile(60, poles=0, direction=(0, 0, 1))
    with pytest.raises(ValueError, match=r"\(36,\) is needed"):
        Tiler(torus.surface, 2, allowed=[True])


def test_cancelling():
    calls = []

    def stop(fraction, stage):
        calls.append(stage)
        return len(calls) < 4

    with pytest.raises(Cancelled):
        Tiler(surface_of(DOUBLE), 4, progress=stop)
    assert Tiler(surface_of(DOUBLE), 4).tile(128).uv.shape[1] == 2


SHARED = {
    "double": DOUBLE,
    "genus 8": families.block_with_holes(8, refine=2),
    "with a level": families.torus(100, 60, jitter=0.2),
    "handle and hole": families.punctured_torus(),
}


@pytest.mark.parametrize("name", SHARED)
@pytest.mark.parametrize(("first", "second"), [("auto", 0), (0, "auto"), (2, 6)])
def test_what_two_placements_share_changes_no_bit(name, first, second):
    surface = surface_of(SHARED[name])
    known, before = Tiler(surface, first, evened=True), holomorph._native.work()
    alone, between = Tiler(surface, second), holomorph._native.work()
    beside, after = Tiler(surface, second, like=known), holomorph._native.work()
    assert beside.poles.vertices.tolist() == alone.poles.vertices.tolist()
    assert beside.tile(64).uv.tobytes() == alone.tile(64).uv.tobytes()
    assert after - between < between - before


def test_a_placement_of_another_surface_gives_nothing():
    known, other = Tiler(surface_of(families.torus(9, 6)), 0), surface_of(families.torus(24, 18))
    assert Tiler(other, 0, like=known).tile(64).uv.tobytes() == Tiler(other, 0).tile(64).uv.tobytes()


def neighbour(mesh, vertex, steps):
    """A vertex so many steps along edges away."""
    faces = np.split(mesh.corners, mesh.offsets[1:-1])
    for _ in range(steps):
        vertex = max(v for face in faces if vertex in face for v in face)
    return int(vertex)


@pytest.mark.parametrize("name", [name for name in CASES if CASES[name][1]["poles"]])
def test_a_pole_is_moved_without_rounding_again(name):
    mesh, options = CASES[name]
    options = dict(options)
    tiler = Tiler(surface_of(mesh), options.pop("poles"), boundary=options.pop("boundary", "straight"))
    before, stages = tiler.tile(**options), []
    place = neighbour(mesh, before.poles[0], 1)
    moved = tiler.move_poles(before, {0: place}, progress=lambda _, stage: stages.append(stage))
    assert not {"rounding", "search for poles"} & set(stages)
    assert moved.poles[0] == place != before.poles[0]
    assert np.allclose(moved.residues, before.residues, rtol=0, atol=EXACT)
    found = jumps(mesh, moved.uv, moved.poles)
    assert np.abs(found[:, 0] - found[:, 1]).max() < EXACT * np.abs(moved.uv).max()
    steps = np.linalg.solve(basis(options), found[:, 0].T)
    assert np.abs(steps - np.rint(steps)).max() < 10 * EXACT * np.abs(moved.uv).max()
    assert np.median(moved.quality.angle) < 1.1 * np.median(before.quality.angle)
    assert np.array_equal(tiler.move_poles(before, {}).uv, before.uv)


def test_other_poles_make_up_for_one_that_is_moved():
    mesh = families.torus(48, 36, shape="triangles", jitter=0.3)
    tiler = Tiler(surface_of(mesh), 6)
    before = tiler.tile(60)
    far = neighbour(mesh, before.poles[0], 4)
    moved = tiler.move_poles(before, {0: far})
    assert moved.added_distortion < 1.002 and len(set(moved.poles) - set(before.poles)) > 1
    chosen = Tiler(surface_of(mesh), before.poles)
    before = chosen.tile(60)
    moved = chosen.move_poles(before, {0: far})
    assert np.array_equal(moved.poles[1:], before.poles[1:])
    assert moved.added_distortion > before.added_distortion + 0.002


@pytest.mark.parametrize("name", ["sphere", "holes, free"])
def test_moved_poles_cost_nothing_on_planar_surfaces(name):
    mesh, options = CASES[name]
    tiler = Tiler(surface_of(mesh), options["poles"], boundary=options.get("boundary", "straight"))
    before = tiler.tile(options["tiles"])
    moved = tiler.move_poles(before, {1: neighbour(mesh, before.poles[1], 2)})
    assert moved.added_distortion == 1 and moved.poles[0] == before.poles[0]


def test_places_that_are_none_are_refused():
    tiler = Tiler(surface_of(TORUS), 4)
    made = tiler.tile(60)
    with pytest.raises(TopologyError, match="no pole 4: the tiling has 4"):
        tiler.move_poles(made, {4: 0})
    with pytest.raises(TopologyError, match="not a vertex"):
        tiler.move_poles(made, {0: 10**6})
    with pytest.raises(TopologyError, match="given twice"):
        tiler.move_poles(made, {0: made.poles[1], 1: made.poles[1]})
    on_disk = Tiler(surface_of(DISK), 3)
    rim = int(np.argmin(DISK.vertices[:, 2]))
    with pytest.raises(TopologyError, match=f"vertex {rim} cannot be a pole"):
        on_disk.move_poles(on_disk.tile(40), {0: rim})
    with pytest.raises(ValueError, match="this Tiler did not make"):
        on_disk.move_poles(made, {0: 1})


@pytest.mark.parametrize("name", ["genus 2, hexagonal", "sphere, brick", "handle and hole"])
def test_poles_are_moved_of_the_tiling_that_is_given(name):
    """Whatever was asked in between: another tiling, with other tiles on another lattice."""
    mesh, options = CASES[name]
    options = dict(options)
    tiler = Tiler(surface_of(mesh), options.pop("poles"))
    before = tiler.tile(**options)
    moves = {0: neighbour(mesh, before.poles[0], 1)}
    alone = tiler.move_poles(before, moves)
    other = tiler.tile(2.5 * before.tiles)
    tiler.move_poles(other, {0: neighbour(mesh, other.poles[0], 2)})
    again = tiler.move_poles(before, moves)
    assert again.tiles == before.tiles != other.tiles
    for one, two in ((alone.uv, again.uv), (alone.periods, again.periods), (alone.residues, again.residues)):
        assert np.array_equal(one, two)


@pytest.mark.parametrize("name", ["torus", "sphere", "handle and hole", "holes, free"])
def test_moved_poles_may_move_on(name):
    """A moved tiling is one: its poles move from where they are, and its jumps stay on the lattice."""
    mesh, options = CASES[name]
    tiler = Tiler(surface_of(mesh), options["poles"], boundary=options.get("boundary", "straight"))
    made = tiler.tile(options["tiles"])
    for pole in (0, 1, 0):
        place = neighbour(mesh, made.poles[pole], 1)
        made = tiler.move_poles(made, {pole: place})
        assert made.poles[pole] == place
        found = jumps(mesh, made.uv, made.poles)
        assert np.abs(found[:, 0] - np.rint(found[:, 0])).max() < 10 * EXACT * np.abs(made.uv).max()


def test_a_boundary_is_straight_but_where_faces_would_collapse():
    def made(mesh, boundary):
        return automatic_structure(surface_of(mesh)).tile(poles=3, tiles=200, boundary=boundary, evenness=0.5)

    blade = {
        boundary: made(families.saw_blade(rings=8, tip=1.04), boundary)
        for boundary in ("automatic", "straight", "free")
    }
    assert np.array_equal(blade["automatic"].uv, blade["free"].uv)
    assert blade["automatic"].quality.lost_part == 0 < blade["straight"].quality.lost_part
    assert np.array_equal(made(DISK, "automatic").uv, made(DISK, "straight").uv)
    assert not np.array_equal(made(DISK, "automatic").uv, made(DISK, "free").uv)
