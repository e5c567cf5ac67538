"""Evened maps of forms: what each kind keeps (exact), what it changes, and the verdict on it."""

from dataclasses import replace

import families
import numpy as np
import pytest
from evened_disks import bumpy_disk, jumps, rim
from holomorph import (
    Cancelled,
    automatic_structure,
    conformal_structure,
    disk_map,
    form_map,
    free_boundary_map,
    log_map,
    rectangle_map,
)
from holomorph.quality.appearance import SHEAR, cost
from holomorph.quality.verdicts import COSTS, SHEARED, UNSEEN, verdict
from measured import Measured
from solved import surface_of

EXACT = 1e-12
SPHERE = families.geodesic_sphere(9, jitter=0.2)
HEIGHT = np.linspace(0, 3, 19)
RING = families.ring_of_revolution(1 + 0.6 * np.cos(2 * HEIGHT), HEIGHT, 24)
HOLES = families.punched(families.geodesic_sphere(12, jitter=0.2), 3)
TORUS = families.torus(24, 18, jitter=0.2)
KINDS = {
    "closed": lambda: conformal_structure(surface_of(TORUS)),
    "strip": lambda: conformal_structure(surface_of(RING)),
    "planar": lambda: conformal_structure(surface_of(HOLES)),
    "planar by its double": lambda: conformal_structure(surface_of(HOLES), boundary="double_cover"),
    "handle and hole": lambda: conformal_structure(surface_of(families.punctured_torus(24, 18))),
    "log": lambda: log_map(surface_of(SPHERE)),
    "log of a solid": lambda: log_map(surface_of(families.tetrahedron())),
    "log with holes": lambda: log_map(surface_of(HOLES)),
    "log with holes, complex": lambda: log_map(surface_of(HOLES), log_map(surface_of(HOLES)).poles, [1j]),
    "disk": lambda: disk_map(bumpy_disk()),
    "rectangle": lambda: rectangle_map(bumpy_disk()),
    "free": lambda: free_boundary_map(bumpy_disk()),
}
kinds, made = {}, {}
everywhere = pytest.mark.parametrize("name", KINDS)


def structure(name):
    if name not in kinds:
        kinds[name] = KINDS[name]()
    return kinds[name]


def mapped(name, evenness):
    key = name, evenness
    if key not in made:
        made[key] = form_map(structure(name).surface, structure(name), evenness=evenness)
    return made[key]


@everywhere
def test_by_default_the_map_is_conformal(name):
    own = structure(name)
    found = form_map(own.surface, own)
    assert found.evenness == 0
    assert np.array_equal(found.uv, own.uv(found.coefficients))
    assert np.array_equal(mapped(name, 0).uv, found.uv)


@everywhere
def test_squares_become_more_equal(name):
    ratios = [mapped(name, evenness).quality.density_ratio for evenness in (0, 0.5, 1)]
    assert mapped(name, 0.5).evenness == 0.5
    if name != "log of a solid":  # which has a pole in every face
        assert ratios[1] < 0.9 * ratios[0] and ratios[2] < 0.95 * ratios[1]


@everywhere
def test_jumps_stay(name):
    native, before, after = structure(name)._triangulation, mapped(name, 0).uv, mapped(name, 0.7).uv
    assert np.abs(jumps(native, after) - jumps(native, before)).max() < EXACT * np.abs(before).max()
    assert np.array_equal(mapped(name, 0).seams, mapped(name, 0.7).seams)


@everywhere
def test_boundaries_keep_their_shape(name):
    """Straight ones move along themselves, round and given ones do not move, free ones do."""
    native, before, after = structure(name)._triangulation, mapped(name, 0).uv, mapped(name, 0.7).uv
    change = (after - before)[np.isin(native.corner_vertices, rim(native))]
    moves = np.abs(change).max(axis=0) if len(change) else np.zeros(2)
    if name in ("strip", "planar", "planar by its double", "handle and hole", "log with holes"):
        assert moves[1] == 0 and moves[0] > 1e-3
    elif name == "disk":
        assert not moves.any()
    elif name in ("free", "log with holes, complex"):
        assert moves.min() > 1e-3


def test_the_centre_of_a_disk_stays():
    own = structure("disk")
    at = own._triangulation.corner_vertices == own.centre
    assert np.array_equal(mapped("disk", 0.8).uv[at], mapped("disk", 0).uv[at])


def test_a_rectangle_stays_one():
    own = structure("rectangle")
    points = np.full((own._triangulation.vertex_count, 2), np.nan)
    points[own._triangulation.corner_vertices] = mapped("rectangle", 0.8).uv
    sides, modulus = points[rim(own._triangulation)], own.modulus
    on_u, on_v = np.isin(sides[:, 0], [0, 1]), np.isin(sides[:, 1], [0, modulus])
    assert (on_u | on_v).all() and np.count_nonzero(on_u & on_v) == 4
    assert points.min() >= 0 and (points.max(axis=0) == (1, modulus)).all()
    assert np.array_equal(points[own.corners], [[0, 0], [1, 0], [1, modulus], [0, modulus]])


def test_a_log_map_still_goes_around_its_poles():
    own = structure("log")
    before, after = mapped("log", 0), mapped("log", 1)
    assert np.array_equal(before.poles, after.poles)
    assert np.isfinite(after.uv).all() and after.kind == "log"
    assert own.quality(after.uv).flipped_part <= own.quality(before.uv).flipped_part


@everywhere
def test_no_more_area_is_flipped(name):
    parts = [mapped(name, evenness).quality.flipped_part for evenness in (0, 0.5, 1)]
    assert max(parts) <= parts[0]


@pytest.mark.parametrize("name", ["closed", "strip", "log", "rectangle", "free"])
def test_same_bits_at_any_number_of_threads(name):
    surface = structure(name).surface
    options = {"boundary": "free"} if name == "free" else {}
    first, other = (automatic_structure(surface, threads=threads, **options) for threads in (1, 3))
    assert np.array_equal(*(form_map(surface, own, evenness=0.5).uv for own in (first, other)))


# ---- the verdict on them ------------------------------------------------------------------------------------------


@everywhere
def test_the_verdict_forgives_what_evening_added_alone(name):
    before, after = mapped(name, 0).quality, mapped(name, 0.5).quality
    added = after.mean_angle - before.mean_angle
    assert before.unseen_angle == 0
    assert after.unseen_angle == pytest.approx(min(max(added, 0), 0.5 * UNSEEN))
    judged = Measured(size_range=after.size_range, mean_angle=after.mean_angle - after.unseen_angle)
    judged.lost_part, judged.flipped_part = after.lost_part, after.flipped_part
    assert after.verdict == verdict(judged)


def forgiven(after):
    """As where evening added at least so much shear."""
    return replace(after, unseen_angle=UNSEEN).verdict


def test_shear_that_evening_added_is_forgiven_in_words_and_level():
    own = structure("free")
    before = own.quality(own.uv())
    for factor, is_told in ((1 + 0.95 * UNSEEN, False), (SHEARED[0] + 1.05 * UNSEEN, True)):
        after = own.quality(own.uv() * [factor, 1.0])
        assert "sheared" in after.verdict.sentence
        assert ("sheared" in forgiven(after).sentence) == is_told
    after = own.quality(own.uv() * [1.05 * SHEARED[1], 1.0])
    assert "slightly sheared" in forgiven(after).sentence  # what is plainly sheared is told
    after = own.quality(own.uv() * [0.999 + (COSTS[1] - cost(before)) / SHEAR + UNSEEN, 1.0])
    assert (after.verdict.level, forgiven(after).level) == ("poor", "fair")


# ---- refused ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("evenness", [-0.1, 1.001, np.nan, "much", None])
def test_bad_evenness_is_refused(evenness):
    with pytest.raises(ValueError, match="a number from 0 .keeps angles. to 1"):
        form_map(structure("free").surface, structure("free"), evenness=evenness)


def test_cancelled():
    with pytest.raises(Cancelled):
        form_map(structure("closed").surface, structure("closed"), evenness=0.5, progress=lambda *_: False)
