"""The verdict on UV maps: thresholds one by one, words, the report and the exit status of the command."""

import json
from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Surface, automatic_structure, form_map, overall, verdict
from holomorph.__main__ import main
from holomorph.maps.report import part_report, whole_report
from holomorph.quality.verdicts import LEVELS, LOST, OVERLAPPING, SHEARED, UNEVEN
from measured import Measured
from mesh_files import obj
from solved import solved, surface_of

POINTS, TRIANGLES = families.hexagonal_disk(6)
FLAT_PIECE = np.pad(POINTS, ((0, 0), (0, 1)))


def disk():
    """(structure, UVs) of a flat disk: conformal and even."""
    return automatic_structure(Surface(FLAT_PIECE, TRIANGLES)), POINTS[TRIANGLES.ravel()]


# ---- levels -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("field", "limits"), [("size_range", UNEVEN), ("mean_angle", SHEARED), ("lost_part", LOST)])
def test_each_quantity_alone_decides_the_level(field, limits):
    """Up to its limits, which belong to the better level; without a number it is the last one."""
    for rank, limit in enumerate(limits):
        assert verdict(Measured(**{field: limit})).level == LEVELS[rank]
        assert verdict(Measured(**{field: np.nextafter(limit, np.inf)})).level == LEVELS[rank + 1]
    assert {verdict(Measured(**{field: value})).level for value in (np.inf, np.nan)} == {"unusable"}


def test_an_island_that_lies_over_itself_is_named():
    """A texture is not harmed, and a bake is: where little does, the map is fair."""
    found = verdict(Measured(overlapping_part=2 * OVERLAPPING[0]))
    assert found.level == "fair" and "overlaps itself: mark one more seam" in found.text
    assert verdict(Measured(overlapping_part=2 * OVERLAPPING[1])).level == "poor"
    assert verdict(Measured(overlapping_part=0.3)).level == "unusable"


def test_islands_are_offered_where_the_mesh_is_too_coarse():
    assert verdict(Measured(mean_angle=2.0)).offers_islands
    assert not verdict(Measured(size_range=15)).offers_islands


def test_a_map_without_distortion_is_good_and_needs_no_advice():
    structure, uv = disk()
    assert structure.quality(uv).verdict == verdict(Measured())
    assert verdict(Measured()).text == "Even"


ISLANDS = "or unwrap it in islands along its hard edges"


@pytest.mark.parametrize(
    ("measured", "tiling", "sentence", "advice"),
    [
        ({}, {"poles": 8}, "Even, seamless, 8 poles", ""),
        ({"overlapping_part": 0.0}, {}, "Even", ""),
        ({"overlapping_part": OVERLAPPING[0]}, {}, "Even", ""),
        ({"overlapping_part": 0.12}, {}, "Even, 12 % of the island overlaps itself", "mark one more seam across"),
        ({"size_range": 15, "overlapping_part": 0.0}, {}, "Uneven (squares of 1 to 15)", "mark a seam up to"),
        ({}, {"poles": 0}, "Even, seamless, no poles", ""),
        ({"size_range": 5}, {}, "Fairly even", "make a seamless tiling, with poles where it is coarse"),
        ({"size_range": 15}, {"poles": 1}, "Uneven (squares of 1 to 15), seamless, 1 pole", "add poles"),
        ({"size_range": 40}, {}, "Very uneven (squares of 1 to 40)", "make a seamless tiling"),
        ({"size_range": np.inf}, {}, "Very uneven (squares of 1 to over 1000)", "make a seamless tiling"),
        ({"mean_angle": 1.3}, {}, "Even, slightly sheared", "subdivide the mesh"),
        ({"mean_angle": 1.3}, {"added_distortion": 1.2}, "Even, slightly sheared", "ask for more tiles"),
        (
            {"mean_angle": 1.3},
            {"poles": 0, "turns": 4, "cones": 8},
            "Even, seamless, slightly sheared, quarter turns, 8 cones",
            "ask for more tiles",
        ),
        ({"mean_angle": 3}, {}, "Even, badly sheared", "subdivide the mesh, which is too coarse"),
        ({"mean_angle": 2, "long_part": 0.9}, {}, "Even, sheared", f"remesh its long thin faces, {ISLANDS}"),
        (
            {"lost_part": 0.03, "flipped": (True,)},
            {},
            "Even, 3 % flipped or collapsed",
            "subdivide the mesh where",
        ),
        (
            {"lost_part": 0.005},
            {},
            "Even, 0.5 % flipped or collapsed",
            "subdivide the mesh where faces have coll",
        ),
    ],
)
def test_words(measured, tiling, sentence, advice):
    found = verdict(Measured(**measured), **tiling)
    assert found.sentence == sentence and found.advice.startswith(advice) and bool(found.advice) == bool(advice)
    assert found.text == (f"{sentence}: {found.advice}" if advice else sentence)


# ---- of real maps -------------------------------------------------------------------------------------------------


def test_no_advice_is_given_twice():
    found = verdict(Measured(mean_angle=1.3, lost_part=0.005, flipped=(True,)))
    assert found.advice == "subdivide the mesh where faces are flipped"


def test_where_a_mesh_is_too_coarse_islands_are_the_only_advice():
    found = verdict(Measured(size_range=100, mean_angle=4, lost_part=0.2, long_part=0.9))
    assert found.advice == f"remesh its long thin faces, {ISLANDS}"


@pytest.mark.parametrize("factor", [np.nan, 0.0, np.inf])
def test_a_map_that_is_nothing_is_never_called_good(factor):
    """No number of it is that of a map without distortion."""
    structure, uv = disk()
    with np.errstate(invalid="ignore"):
        quality = structure.quality(uv * factor)
    assert quality.verdict.level == "unusable"
    assert quality.verdict.sentence == "No texture is visible: the map has no area"
    assert quality.size_range == quality.density_ratio == np.inf and quality.mean_angle == pytest.approx(10)
    assert quality.collapsed.all() and quality.lost_part == pytest.approx(1) and quality.median_density == 0


def test_half_a_map_that_is_nothing_is_unusable():
    structure, uv = disk()
    half = np.where(np.arange(len(uv))[:, None] < len(uv) // 2, 0.0, uv)
    quality = structure.quality(half)
    assert quality.verdict.level == "unusable" and "50 % flipped or collapsed" in quality.verdict.sentence


def test_shear_of_a_stretched_map():
    """s1 / s2 is the factor."""
    structure, uv = disk()
    levels = [structure.quality(uv * [factor, 1.0]).verdict.level for factor in (1.1, 1.3, 1.9, 3.0)]
    assert levels == list(LEVELS)


def test_long_faces_are_told_from_coarse_ones():
    """The cells of a flat grid, stretched by ten."""
    structure, uv = disk()
    stretched = automatic_structure(Surface(FLAT_PIECE * [10.0, 1.0, 1.0], TRIANGLES))
    assert structure.quality(uv).long_part == 0 and stretched.quality(uv).long_part > 0.5


def test_a_tiling_is_called_seamless():
    made = solved("torus of triangles").tile(tiles=64)
    words = made.verdict.sentence.split(", ")
    assert words[:2] == ["Even", "seamless"] and words[-1] == f"{len(made.poles)} poles" and made.verdict.is_fit


# ---- of meshes of several parts -------------------------------------------------------------------------------------


def test_the_worst_part_decides():
    good, poor = verdict(Measured()), verdict(Measured(size_range=15))
    assert overall([good, good]) == good and overall([poor]) == poor
    found = overall([good, poor, good])
    assert found.level == "poor" and found.advice == poor.advice
    assert found.sentence == "1 of 3 parts is poor: uneven (squares of 1 to 15)"
    assert overall([good, poor, poor]).sentence.startswith("2 of 3 parts are poor: uneven")


def test_a_part_without_a_hundredth_of_the_area_is_named_and_does_not_decide():
    good, poor = verdict(Measured()), verdict(Measured(size_range=15))
    found = overall([good, poor], [1000, 1])
    assert found.level == "good" and found.sentence == "Even; 1 small part is poor"
    assert overall([good, poor], [1000, 100]).level == "poor"
    assert overall([good] + [poor] * 20, [1000] + [1] * 20).level == "poor"  # together they have enough


@pytest.mark.parametrize(
    ("told", "level"),
    [
        ({"sizes": 1.04}, "good"),
        ({"sizes": 2}, "poor"),
        ({"unmapped": 0.001}, "good"),
        ({"unmapped": 0.99}, "unusable"),
    ],
)
def test_the_whole_counts(told, level):
    good = verdict(Measured())
    found = overall([good, good], **told)
    assert found.level == level
    assert ("factor of 2" in found.sentence) == (told.get("sizes") == 2)
    assert ("no map" in found.sentence) == ("unmapped" in told)


def test_squares_that_differ_by_what_an_eye_sees_are_told():
    """An eye tells lengths that differ by a twentieth (Weber's fraction)."""
    good = verdict(Measured())
    assert overall([good, good], sizes=1.04) == good
    assert "differ in size" in overall([good, good], sizes=1.06).sentence


def two_sizes(scale):
    """Two tori of which one is `scale` times as large."""
    mesh = families.torus(24, 12)
    return families.united(mesh, replace(mesh, vertices=mesh.vertices * scale + 10))


def test_figures_of_several_parts_are_those_of_all_faces():
    surface = surface_of(two_sizes(3.0))
    parts = surface.components
    maps = [form_map(part, automatic_structure(part)) for part in parts]
    found = whole_report(maps, [part_report(made) for made in maps], surface.repairs)
    assert found["whole"]["text"] == "2 parts: 2 cut open" and found["whole"]["sizes"] == 1
    for name in ("mean_angle", "size_range"):
        assert found["whole"][name] == pytest.approx(getattr(maps[0].quality, name), rel=1e-6)


def test_faces_left_out_count():
    surface = surface_of(families.torus(9, 6))
    made = form_map(surface, automatic_structure(surface))
    parts = [part_report(made), {"done": False, "faces": 500, "reason": "its coordinates are not finite"}]
    found = whole_report([made], parts, surface.repairs)
    assert found["verdict"]["level"] == "unusable" and "no map" in found["verdict"]["sentence"]
    assert found["whole"]["text"] == "500 faces left out" and found["whole"]["unmapped_faces"] == 500
    assert whole_report([], parts[1:], surface.repairs) == {"verdict": None, "whole": None}


# ---- the command ----------------------------------------------------------------------------------------------------


def file_of(mesh, path):
    path.write_bytes(obj(mesh))
    return path


def ball_with_spikes():
    """Three of them, of which two have a puncture of the log map."""
    ball = families.geodesic_sphere(12)
    factor = 1 + 6 * np.exp(-12 * (1 - ball.vertices.max(axis=1)))
    return replace(ball, vertices=ball.vertices * factor[:, None])


def run(capsys, *arguments):
    """(exit status, report, what is said on the error stream)."""
    status = main([str(argument) for argument in arguments])
    told = capsys.readouterr()
    return status, json.loads(told.out), told.err


@pytest.mark.parametrize(("strict", "status"), [((), 0), (("--strict",), 3)])
def test_strict_ends_with_the_verdict(tmp_path, capsys, strict, status):
    path = file_of(ball_with_spikes(), tmp_path / "spikes.obj")
    ended, report, told = run(capsys, path, *strict)
    found = report["verdict"]
    assert (ended, found["level"]) == (status, "poor") and found == report["components"][0]["main_map"]["verdict"]
    assert told == (f"holomorph: {found['sentence']}: {found['advice']}\n" if strict else "")


def test_strict_takes_what_is_good(tmp_path, capsys):
    path = file_of(families.torus(48, 24), tmp_path / "torus.obj")
    status, report, told = run(capsys, path, "--strict")
    assert (status, report["verdict"]["level"], told) == (0, "good", "")


def test_strict_wants_every_part(tmp_path, capsys):
    flat = families.moved(families.tetrahedron(), scale=0)
    path = file_of(families.united(families.torus(24, 12), flat), tmp_path / "two.obj")
    assert run(capsys, path)[0] == 0
    status, _, told = run(capsys, path, "--strict")
    assert status == 3 and told.startswith("holomorph: 1 of 2 parts have no map: ")
