"""Meshes of many loose parts: work and reports grow no faster than their number."""

import functools
import json
import sys

import numpy as np
import pytest
from holomorph import Surface, TopologyError, automatic_maps, automatic_structure
from holomorph.batch import mapping
from holomorph.batch.recipe import Maps, Recipe
from holomorph.maps.automatic_structure import LateStructure
from holomorph.maps.report import MOST_ALIKE, part_count, part_report, parts_report

AUTOMATIC = Recipe(maps=Maps(main="automatic"))
MOST_GROWTH = 1.05  # of calls, for what differs between parts


def leaves(count, corners=4):
    """Polygons that lie apart, each flat and of a shape of its own."""
    rng = np.random.default_rng(1)
    angles = np.sort(rng.uniform(0, 2 * np.pi, (count, corners)) / 3 + 2 * np.pi * np.arange(corners) / corners)
    tilt = rng.normal(size=(count, 2, 3))
    points = np.cos(angles)[..., None] * tilt[:, :1] + np.sin(angles)[..., None] * tilt[:, 1:]
    points += rng.uniform(-50, 50, (count, 1, 3))
    return Surface(points.reshape(-1, 3), np.arange(count * corners).reshape(count, corners).tolist())


def mapped(surface):
    """The report of the command."""
    parts = mapping.map_parts(surface, AUTOMATIC)
    mapping.main_uv(surface, parts, AUTOMATIC.maps)
    return mapping.report(surface, parts, AUTOMATIC)


def calls_of(work):
    """How many functions Python calls meanwhile."""
    count = 0

    def called(_frame, event, _argument):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(called)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def test_calls_grow_like_the_number_of_parts():
    """Those that more parts add are no more where there are many already."""
    mapped(leaves(2))  # what is imported and kept once
    first, second, third = (calls_of(functools.partial(mapped, leaves(2 * MOST_ALIKE * times))) for times in (1, 2, 3))
    assert third - second < MOST_GROWTH * (second - first)


def test_reports_of_many_like_parts_are_small():
    found = [mapped(leaves(MOST_ALIKE + more)) for more in (1, 200)]
    few, many = (len(json.dumps(report["components"])) for report in found)
    assert many == pytest.approx(few, rel=0.02)
    assert [part_count(report["components"]) for report in found] == [MOST_ALIKE + 1, MOST_ALIKE + 200]
    assert [len(report["components"]) for report in found] == [MOST_ALIKE + 1] * 2


def test_an_entry_that_parts_share_has_their_sums_and_the_worst_of_them():
    surface = leaves(MOST_ALIKE + 3)
    components = mapped(surface)["components"]
    assert sum(part["faces"] for part in components) == MOST_ALIKE + 3
    assert sum(part["vertices"] for part in components) == 4 * (MOST_ALIKE + 3)
    assert sum(part["area"] for part in components) == pytest.approx(surface.area)
    maps = automatic_maps(surface)
    worst = max(made.quality.density_ratio for made in maps[MOST_ALIKE:])
    assert components[-1]["main_map"]["size_range"] == pytest.approx(worst**0.5)


def test_parts_with_another_reason_or_note_have_entries_of_their_own():
    surface = leaves(MOST_ALIKE + 4)
    parts = [(part, None, "too round", "") for part in surface.components]
    parts[-1] = (*parts[-1][:2], "too flat", "")
    parts[-2] = (*parts[-2][:3], "the poles lie elsewhere")
    components = parts_report(parts, (), surface.repairs)["components"]
    assert [entry.get("parts", 1) for entry in components[MOST_ALIKE:]] == [2, 1, 1]
    assert components[-1]["reason"] == "too flat" and components[-2]["not_followed"] == "the poles lie elsewhere"


@pytest.mark.parametrize("corners", [3, 4, 7])
def test_loose_faces_need_no_structure_until_it_is_asked_for(corners):
    for found in automatic_maps(leaves(3, corners)):
        assert found.islands and isinstance(found.structure, LateStructure)
        assert part_report(found)["description"] == found.why and "made" not in vars(found.structure)
        expected = automatic_structure(found.surface)
        assert found.structure.balanced_coefficients().shape == expected.balanced_coefficients().shape


def test_what_refuses_a_part_is_told():
    """A choice that does not fit one part; the others have maps."""
    chosen = Recipe(maps=Maps(main="automatic", rectangle_corners=(0, 1, 2, 3)))
    surface = leaves(3)
    parts = mapping.map_parts(surface, chosen)
    assert [part.is_chosen for part in parts] == [True, False, False] and all(part.map for part in parts)
    with pytest.raises(TopologyError):
        mapping.map_parts(surface, Recipe(maps=Maps(poles=(99,))))
