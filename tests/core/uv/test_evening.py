"""Evening: squares of nearly one size; jumps and straight boundaries stay (exact), flips do not become more."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Cancelled, Surface, Tiler, automatic_structure
from solved import CLOSED, surface_of

EXACT = 1e-12
SPHERE = families.geodesic_sphere(9, jitter=0.25)
DOUBLE = families.block_with_holes(2, refine=4, jitter=0.2)
HOLES = families.punched(families.geodesic_sphere(12, jitter=0.2), 3)
CASES = {
    "sphere": (SPHERE, 4),
    "torus": (CLOSED["torus of triangles"], 0),
    "torus of quads": (CLOSED["torus of quads"], 3),
    "genus 2": (DOUBLE, 4),
    "handle and hole": (families.punctured_torus(24, 18), 2),
    "holes": (HOLES, 2),
}


def on_boundary(mesh):
    """(#C,) bool."""
    start, end = mesh.corners, np.concatenate([np.roll(face, -1) for face in mesh.faces])
    edges = set(zip(start.tolist(), end.tolist()))
    rim = {a for a, b in edges if (b, a) not in edges} | {b for a, b in edges if (b, a) not in edges}
    return np.isin(start, list(rim))


everywhere = pytest.mark.parametrize("name", CASES)
tilers = {}


def tiler(name):
    if name not in tilers:
        mesh, poles = CASES[name]
        tilers[name] = Tiler(surface_of(mesh), poles)
    return tilers[name]


def tiling(name, evenness):
    return tiler(name).tile(100, evenness=evenness)


@everywhere
def test_without_evening_the_map_is_the_conformal_one(name):
    conformal, half = tiler(name).tile(100), tiling(name, 0.5)
    assert (conformal.evenness, half.evenness) == (0, 0.5)
    assert not np.array_equal(conformal.uv, half.uv)
    assert np.array_equal(tiler(name).even(half, 0).uv, conformal.uv)
    assert np.array_equal(tiler(name).even(conformal, 0.5).uv, half.uv)


def test_a_shortened_step_does_not_end_the_evening(meshes):
    """On the body the first step at 0.5 is a quarter, and lowers the energy by less than 1 in 300."""
    parts = Surface.read(meshes / "makehuman_base_quads.obj").components
    structure = automatic_structure(max(parts, key=lambda part: part.area))
    made = [structure.tile(evenness=evenness, direction="upright") for evenness in (0.4, 0.5, 0.6)]
    ranges = [tiling.size_range for tiling in made]
    assert ranges[0] > ranges[1] > ranges[2] and ranges[0] < 2


@everywhere
def test_squares_become_more_equal_and_more_sheared(name):
    made = [tiling(name, evenness).quality for evenness in (0, 0.25, 0.5, 1)]
    ratios = [quality.density_ratio for quality in made]
    assert all(after < 0.95 * before for before, after in zip(ratios, ratios[1:]))
    shears = [quality.mean_angle for quality in made[1:]]
    assert all(after > before for before, after in zip(shears, shears[1:]))
    assert shears[-1] < 1.6


@everywhere
def test_a_ratio_is_about_the_power_that_is_foretold(name):
    """The power 0.6 at evenness 0.5 is a cautious one of other meshes."""
    before, after = (np.log(tiling(name, evenness).size_range) for evenness in (0, 0.5))
    assert after == pytest.approx(0.6 * before, rel=0.35)


@everywhere
def test_no_more_area_is_flipped(name):
    before, *after = (tiling(name, evenness).quality.flipped_part for evenness in (0, 0.5, 1))
    assert max(after) <= before


@everywhere
def test_numbers_of_the_conformal_map_stay(name):
    conformal, even = tiling(name, 0), tiling(name, 1)
    for field in ("periods", "poles", "residues", "seams"):
        assert np.array_equal(getattr(conformal, field), getattr(even, field))
    assert conformal.added_distortion == even.added_distortion


@pytest.mark.parametrize("name", ["handle and hole", "holes"])
def test_boundaries_stay_straight(name):
    conformal, even = tiling(name, 0), tiling(name, 0.7)
    change = even.uv - conformal.uv
    change -= np.rint(change[0])  # both are moved by whole tiles
    at = on_boundary(CASES[name][0])
    assert np.abs(change[at, 1] - np.rint(change[at, 1])).max() < EXACT
    assert np.abs(change[at, 0]).max() > 1e-3


def test_a_free_boundary_moves():
    own = Tiler(surface_of(HOLES), 2, boundary="free")
    conformal = own.tile(60)
    even = own.even(conformal, 0.5)
    change = even.uv - conformal.uv
    assert np.abs(change - np.rint(change))[on_boundary(HOLES)].max(axis=0).min() > 1e-3
    assert even.size_range < conformal.size_range


@pytest.mark.parametrize("name", ["sphere", "genus 2", "holes"])
def test_same_bits_at_any_number_of_threads(name):
    mesh, poles = CASES[name]
    made = [Tiler(surface_of(mesh), poles, threads=threads).tile(100, evenness=0.8) for threads in (1, 2, 4)]
    assert np.array_equal(made[0].uv, made[1].uv)
    assert np.array_equal(made[0].uv, made[2].uv)


def test_a_moved_pole_keeps_the_evenness():
    own, before = tiler("sphere"), tiling("sphere", 0.5)
    there = int(np.setdiff1d(np.arange(len(SPHERE.vertices)), before.poles)[40])
    moved = own.move_poles(before, {0: there})
    assert moved.evenness == 0.5
    assert np.array_equal(moved.uv, own.even(own.move_poles(before, {0: there}, evenness=0), 0.5).uv)


@pytest.mark.parametrize(("axes", "fewer"), [((1, 0.5, 0.2), 1), ((1, 1, 0.15), 0), ((1, 1, 4), 0)])
def test_fewer_poles_are_enough(axes, fewer):
    sphere = families.geodesic_sphere(12)
    surface = surface_of(replace(sphere, vertices=sphere.vertices * axes))
    assert len(Tiler(surface, evened=True).poles.vertices) <= len(Tiler(surface).poles.vertices) - fewer


def test_a_surface_that_hardly_has_more_than_poles():
    own = Tiler(surface_of(families.geodesic_sphere(1)), 2)
    conformal, even = own.tile(20), own.tile(20, evenness=1)
    assert np.isfinite(even.uv).all()
    assert even.quality.flipped_part <= conformal.quality.flipped_part


def test_cancelling_keeps_the_tiling():
    own, made = tiler("genus 2"), tiling("genus 2", 0)
    before = made.uv.copy()
    stages = []

    def stop(fraction, stage):
        stages.append(stage)
        return False

    with pytest.raises(Cancelled):
        own.even(made, 0.5, progress=stop)
    assert stages == ["evening"]
    assert np.array_equal(own.even(made, 0).uv, before)


@pytest.mark.parametrize("evenness", [-0.1, 1.001, np.nan, np.inf, "much", None, 0.5j])
def test_refused(evenness):
    own, made = tiler("sphere"), tiling("sphere", 0)
    for ask in (lambda: own.tile(40, evenness=evenness), lambda: own.even(made, evenness)):
        with pytest.raises(ValueError, match="a number from 0 .keeps angles. to 1"):
            ask()


def test_only_own_tilings_are_evened():
    with pytest.raises(ValueError, match="did not make"):
        tiler("sphere").even(tiling("torus", 0), 0.5)
