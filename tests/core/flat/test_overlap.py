"""Islands that cover themselves: the part that is covered twice, against exact areas, and none where there is none."""

import families
import numpy as np
import pytest
from holomorph import Cancelled, Surface, conformal_structure, free_boundary_map
from holomorph.quality.appearance import overlapping_part
from holomorph.quality.verdicts import baking
from island_checks import cut_along
from solved import surface_of

ROUNDING = 1e-9
SAMPLED = 2.0 / 100  # an area that is added up from at least a hundred lines


def closed(points):
    points = np.asarray(points, complex)
    return np.stack([points, np.roll(points, -1)], axis=1)


def finely(points, count=64):
    """Each side in as many parts."""
    start, end = closed(points).T
    return (start[:, None] + (end - start)[:, None] * np.arange(count) / count).ravel()


SQUARE = [0, 1, 1 + 1j, 1j]
OVERLAPPING_SQUARES = np.concatenate([closed(finely(SQUARE)), closed(finely(np.add(SQUARE, 0.5 + 0.5j)))])


@pytest.mark.parametrize(
    ("name", "curve", "part"),
    [
        ("a square", closed(finely(SQUARE)), 0),
        ("three corners", closed([0, 1, 1j]), 0),
        ("a circle", closed(np.exp(2j * np.pi * np.arange(500) / 500)), 0),
        ("a circle passed twice", closed(np.exp(4j * np.pi * np.arange(500) / 500)), 1),
        ("two squares apart", np.concatenate([closed(finely(SQUARE)), closed(finely(np.add(SQUARE, 2)))]), 0),
        ("two that share a fourth", OVERLAPPING_SQUARES, 1 / 7),
        ("a slit", closed(finely([0, 1, 1 + 0.5j, 0.2 + 0.5j, 1 + 0.5j, 1 + 1j, 1j])), 0),
        ("nothing", closed([0, 0, 0]), 0),
        ("a line", closed([0, 1, 2]), 0),
    ],
)
def test_known_areas(name, curve, part):
    assert overlapping_part(curve) == pytest.approx(part, abs=SAMPLED * part + ROUNDING)


@pytest.mark.parametrize("turn", [0.3, 1.0, 2.5])
def test_turns_size_and_mirrors_do_not_matter(turn):
    moved = 1e7 * np.exp(1j * turn) * OVERLAPPING_SQUARES + 3e6j
    assert overlapping_part(moved) == pytest.approx(1 / 7, rel=SAMPLED)
    assert overlapping_part(np.conj(moved)) == pytest.approx(1 / 7, rel=SAMPLED)


def test_a_narrow_overlap_is_found():
    """It is a hundredth of the height, which is many lines."""
    curve = np.concatenate([closed(finely(SQUARE)), closed(finely(np.add(SQUARE, 0.99j)))])
    assert overlapping_part(curve) == pytest.approx(0.01 / 1.99, rel=0.1)


def test_lines_are_looked_at_in_parts():
    """The edges of a star cross all lines: more of them than have room at once."""
    count, spikes = 8000, np.exp(2j * np.pi * np.arange(16_000) / 16_000) * np.tile([1, 0.01], 8000)
    angle = 2 * np.pi / count / 2
    part = overlapping_part(closed(spikes))
    assert part == pytest.approx(0, abs=ROUNDING)
    twice = overlapping_part(np.concatenate([closed(spikes), closed(spikes * np.exp(2j * angle))]))
    assert twice == pytest.approx(1, abs=SAMPLED)
    with pytest.raises(Cancelled):
        overlapping_part(closed(spikes), lambda *_: False)


def helix(turns, n=200):
    """A strip that winds around an axis, rising: flattened it is a ring passed several times."""
    angle = np.linspace(0, 2 * np.pi * turns, n)
    rails = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.05 * angle], axis=1) for r in (1, 1.5, 2)]
    i = np.arange(n - 1)
    quads = [np.stack([i + k * n, i + (k + 1) * n, i + 1 + (k + 1) * n, i + 1 + k * n], axis=1) for k in range(2)]
    return Surface(np.concatenate(rails), np.concatenate(quads))


@pytest.mark.parametrize(("turns", "overlaps"), [(0.8, False), (1.5, True)])
def test_a_strip_that_winds_more_than_once_overlaps_itself(turns, overlaps):
    structure = free_boundary_map(helix(turns))
    quality = structure.quality(structure.uv())
    assert not quality.flipped.any()
    if overlaps:
        assert 0.3 < quality.overlapping_part < 1 and not baking(quality.overlapping_part, 0.0, 1.0).is_fit
    else:
        assert quality.overlapping_part == 0 and quality.verdict.level == "good"


def test_one_more_seam_ends_it():
    surface = helix(1.5)
    n = len(surface.vertices) // 3
    seam = np.array([[n // 2, n // 2 + n], [n // 2 + n, n // 2 + 2 * n]])
    parts = cut_along(surface, seam)
    assert len(parts) == 2
    for part in parts:
        structure = free_boundary_map(part)
        assert structure.quality(structure.uv()).overlapping_part == 0


def test_maps_that_are_no_islands_do_not_tell():
    structure = conformal_structure(surface_of(families.torus(12, 9)))
    assert structure.quality(structure.uv(structure.balanced_coefficients())).overlapping_part is None


def test_a_map_without_finite_values_covers_nothing():
    structure = free_boundary_map(helix(0.8))
    quality = structure.quality(structure.uv() * np.nan)
    assert quality.overlapping_part == 0 and quality.verdict.level == "unusable"
