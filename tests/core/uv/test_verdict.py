"""The verdict on UV maps: thresholds one by one, words, the report and the exit status of the command."""

import json
from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Seen, Surface, Verdict, automatic_map, automatic_structure, form_map, verdict
from holomorph.__main__ import main
from holomorph.maps.report import part_report, refused_report, skipped_report, whole_report
from holomorph.quality.appearance import SHEAR
from holomorph.quality.verdicts import COSTS, LEVELS, OVERLAPPING, baking
from island_checks import cut_along
from measured import Measured
from mesh_files import obj
from solved import solved, surface_of

POINTS, TRIANGLES = families.hexagonal_disk(6)
FLAT_PIECE = np.pad(POINTS, ((0, 0), (0, 1)))


def disk():
    """(structure, UVs) of a flat disk: conformal and even."""
    return automatic_structure(Surface(FLAT_PIECE, TRIANGLES)), POINTS[TRIANGLES.ravel()]


# ---- levels -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rank", range(len(COSTS)))
def test_the_cost_to_the_eye_decides_the_level(rank):
    """Up to its limit, which belongs to the better level, whatever the cost is of."""
    for name, value in (("mean_angle", 1 + COSTS[rank] / SHEAR), ("size_range", np.exp(COSTS[rank] / 2))):
        assert verdict(Measured(**{name: value * (1 - 1e-9)})).level == LEVELS[rank]
        assert verdict(Measured(**{name: value * (1 + 1e-9)})).level == LEVELS[rank + 1]
    assert verdict(Measured(), Seen(cost=COSTS[rank])).level == LEVELS[rank]
    assert verdict(Measured(), Seen(cost=COSTS[rank] * 1.001)).level == LEVELS[rank + 1]


@pytest.mark.parametrize("value", [np.inf, np.nan])
@pytest.mark.parametrize("name", ["size_range", "mean_angle", "lost_part"])
def test_what_is_no_number_is_unusable(name, value):
    assert verdict(Measured(**{name: value})).level == "unusable"


def test_what_overlaps_is_told_of_a_bake_alone():
    """A texture that tiles does not show it."""
    assert verdict(Measured(overlapping_part=0.3)) == verdict(Measured())
    levels = [baking(part, 0.0, 0.9).level for part in (0.0, OVERLAPPING[0], *(1.01 * part for part in OVERLAPPING))]
    assert levels == ["good", "good", "fair", "poor", "unusable"]
    assert baking(0.02, 0.0, 0.9).sentence == "2 % of it overlaps, 90 % of the image is used"
    assert baking(0.0, 0.0, 0.1).level == "fair"
    used = [baking(0.0, 0.0, part).sentence for part in (1.0, 0.9973, 0.0034, 7e-7)]
    words = ("100 %", "100 %", "0.34 %", "less than 0.01 %")
    assert used == [f"Nothing overlaps, {part} of the image is used" for part in words]
    lies = "tiles lie on top of each other"
    for part, where in ((1.0, "this one"), (0.25, "25 % of this one")):
        assert baking(0.0, part, 0.9).sentence == f"Press Bake Tiling for a second map: on {where}, {lies}"


def test_a_map_without_distortion_is_good():
    structure, uv = disk()
    assert structure.quality(uv).verdict == verdict(Measured()) == Verdict("good", "Even")


@pytest.mark.parametrize(
    ("measured", "seen", "sentence"),
    [
        ({}, {"poles": 8, "seams": 0.0}, "Even, seamless, 8 poles"),
        ({}, {"poles": 0, "seams": 0.0}, "Even, seamless, no poles"),
        ({}, {"seams": 0.0}, "Even, no seams"),
        ({}, {"seams": 0.04, "hidden": 3.0}, "Even, seams at hard edges"),
        ({}, {"seams": 14.0}, "Even, long seams in view"),
        ({}, {"seams": 1.27, "hidden": 3.0}, "Even, seams in view"),
        ({}, {"seams": 0.1, "hidden": 3.0}, "Even, short seams in view"),
        ({"size_range": 1.5**0.5}, {}, "Even"),
        ({"size_range": 2.5**0.5}, {}, "Fairly even"),
        ({"size_range": 2.0}, {}, "Uneven (squares of 1 to 2)"),
        ({"size_range": 7**0.5}, {}, "Very uneven (squares of 1 to 2.6)"),
        ({"size_range": np.inf}, {}, "Very uneven (squares of 1 to over 1000)"),
        ({"mean_angle": 1.3}, {}, "Even, slightly sheared"),
        ({"mean_angle": 3}, {}, "Even, badly sheared"),
        (
            {"mean_angle": 1.3},
            {"poles": 0, "seams": 0.0, "turns": 4, "cones": 8},
            "Even, seamless, slightly sheared, quarter turns, 8 cones",
        ),
        ({}, {"poles": 2, "turns": 6}, "Even, sixth turns, no cones, 2 poles"),
        ({"lost_part": 0.03}, {}, "Even, 3 % flipped or collapsed"),
        ({}, {"unmapped": 0.25}, "Even, 25 % without a map"),
        ({"lost_part": 0.001}, {"unmapped": 0.001}, "Even"),
        ({}, {"folded": 0.11}, "Even, the mesh is folded over itself"),
    ],
)
def test_words(measured, seen, sentence):
    assert verdict(Measured(**measured), Seen(**seen)).sentence == sentence


# ---- of real maps -------------------------------------------------------------------------------------------------


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
    levels = [structure.quality(uv * [factor, 1.0]).verdict.level for factor in (1.1, 1.9, 3.0, 4.0)]
    assert levels == list(LEVELS)


def test_a_tiling_is_called_seamless():
    made = solved("torus of triangles").tile(tiles=64, evenness=0.5)
    words = made.verdict.sentence.split(", ")
    assert words[1] == "seamless" and words[-1] == f"{len(made.poles)} poles" and made.verdict.is_fit


# ---- of meshes of several parts -------------------------------------------------------------------------------------


def map_of(mesh):
    surface = surface_of(mesh)
    return form_map(surface, automatic_structure(surface))


def whole_of(*meshes):
    surface = surface_of(families.united(*meshes))
    maps = [form_map(part, automatic_structure(part)) for part in surface.components]
    return whole_report(maps, [part_report(made) for made in maps], surface.repairs)


@pytest.mark.parametrize(("sizes", "is_good"), [((1.0, 0.02), True), ((0.02, 1.0), False)])
def test_parts_count_by_area_and_not_by_number(sizes, is_good):
    """A flat sheet, and a ball with spikes."""
    sheet, spiky = families.uniform(FLAT_PIECE, TRIANGLES), ball_with_spikes()
    meshes = [families.moved(mesh, scale=size) for mesh, size in zip((sheet, spiky), sizes)]
    crowd = [families.moved(meshes[is_good], scale=0.01, seed=k) for k in range(9)]
    alone, beside = whole_of(*meshes), whole_of(*meshes, *crowd)
    assert beside["verdict"]["level"] == alone["verdict"]["level"]
    assert (alone["verdict"]["level"] == "good") == is_good


def test_poles_are_those_of_the_object():
    parts = [Seen(poles=2, cost=1.0, seams=0.0), Seen(poles=3, cost=0.0, seams=0.5), Seen()]
    found = Seen.joined(parts, [3, 1, 0], 0.25)
    assert (found.poles, found.cost, found.seams, found.unmapped) == (5, 0.75, 0.125, 0.25)
    assert Seen.joined([Seen()], [0.0], 0.0) == Seen()
    for areas in ([1.0], [1.0, -1.0, 2.0]):
        with pytest.raises(ValueError, match="areas"):
            Seen.joined(parts, areas, 0.0)


@pytest.mark.parametrize(("part", "is_told"), [(0.09, False), (0.11, True)])
def test_tilings_of_little_area_are_not_told(part, is_told):
    """Such as a knob beside flat leaves."""
    tiled = Seen(poles=3, turns=4, cones=8, lines="mirror", seams=0.0)
    found = Seen.joined([Seen(seams=0.0), tiled], [1 - part, part], 0.0)
    assert (found.poles, found.turns, found.cones) == ((3, 4, 8) if is_told else (None, 1, 0))
    assert ("quarter turns" in verdict(Measured(), found).sentence) == is_told


@pytest.mark.parametrize(
    ("kinds", "told"),
    [
        (("mirror", "mirror"), "mirror"),
        (("mirror", "none"), "none"),
        (("none", "mirror"), "none"),
        (("whole", "free"), "none"),
    ],
)
def test_lines_are_told_where_nearly_all_has_them(kinds, told):
    for size in (0.8, 0.01):  # of a second part, which does not count when it is small, nor a third that does not turn
        parts = [Seen(turns=4, lines=lines) for lines in kinds] + [Seen()]
        found = Seen.joined(parts, [1 - size, size, 1], 0.0)
        assert found.lines == (kinds[0] if size < 0.1 else told)


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


@pytest.mark.parametrize(("scale", "is_seen"), [(0.01, False), (1.0, True)])
def test_parts_without_a_map_count_by_area(scale, is_seen):
    surface = surface_of(families.united(families.torus(9, 6), families.moved(families.torus(9, 6), scale=scale)))
    kept, left = surface.components
    parts = [part_report(form_map(kept, automatic_structure(kept))), skipped_report(left, "too large")]
    found = whole_report([form_map(kept, automatic_structure(kept))], parts, surface.repairs)
    assert found["whole"]["text"] == f"{len(left.face_index)} faces left out"
    assert ("without a map" in found["verdict"]["sentence"]) == is_seen
    assert whole_report([], parts[1:], surface.repairs) == {"verdict": None, "bake": None, "whole": None}


def test_the_cost_of_a_part_is_that_by_which_it_was_chosen():
    made = map_of(families.torus(9, 6))
    found = whole_report([made], [part_report(made)], made.surface.repairs)
    assert found["whole"]["cost"] == pytest.approx(made.cost, rel=1e-12)


def test_parts_without_area_are_not_mentioned():
    mesh = families.united(families.torus(9, 6), families.moved(families.tetrahedron(), scale=0))
    surface = Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False)
    (refused,), made = surface.refused, form_map(surface, automatic_structure(surface))
    found = whole_report([made], [part_report(made), refused_report(refused)], surface.repairs)
    assert found["whole"]["text"] == "" and found["verdict"] == vars(made.verdict)


def sheet(bent, count=8):
    """(vertices, quads) of a unit square that is bent by this angle about its middle."""
    x, y = np.stack(np.meshgrid(*2 * [np.linspace(0, 1, count + 1)], indexing="ij")).reshape(2, -1)
    away = np.maximum(x - 0.5, 0)
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    quads = corner[:, None] + [0, count + 1, count + 2, 1]
    points = np.stack([np.minimum(x, 0.5) + away * np.cos(bent), y, away * np.sin(bent)], axis=1)
    return points, quads


def of_islands(surface, rows):
    """The report on the flat islands that a seam along these rows of the middle of a `sheet` leaves."""
    middle = np.arange(36, 45)[rows]
    parts = cut_along(surface, np.stack([middle[:-1], middle[1:]], axis=1))
    maps = [automatic_map(part, main="untiled") for part in parts]
    return whole_report(maps, list(map(part_report, maps)), surface.repairs)


@pytest.mark.parametrize("is_turned", [False, True])
@pytest.mark.parametrize(("bent", "seams"), [(0, 1), (np.pi / 9, 2 / 3), (np.pi / 2, 0)])
def test_seams_that_cut_a_mesh_into_parts_are_seen(bent, seams, is_turned):
    points, quads = sheet(bent)
    if is_turned:  # faces on one side run the other way
        quads = np.where(points[quads][:, :, 0].mean(axis=1)[:, None] > 0.5, quads[:, ::-1], quads)
    found = of_islands(Surface(points, quads, strict=False), slice(None))
    assert found["whole"]["seams"] == pytest.approx(seams, abs=1e-9)
    words = "seams in view" if seams else "seams at hard edges"
    assert found["verdict"]["sentence"] == f"Even, {words}"


@pytest.mark.parametrize(("height", "is_seen"), [(0, False), (1, True)])
def test_a_cut_that_ends_inside_is_seen_where_the_map_opens(height, is_seen):
    points, quads = sheet(0)
    points[:, 2] = height * np.exp(-8 * ((points[:, :2] - 0.5) ** 2).sum(axis=1))
    found = of_islands(Surface(points, quads), slice(5))
    assert (found["whole"]["seams"] > 0.1) == is_seen and (found["whole"]["seams"] > 0) == is_seen


@pytest.mark.parametrize(("end", "is_folded"), [((2.0, -1.0), True), ((2.0, 1.0), False)])
def test_a_mesh_that_is_folded_over_itself_is_said(end, is_folded):
    """A strip that turns back sharply, through itself or like a blade."""
    profile = np.array([(0.0, 0.0), (4.0, 0.0), (1.0, 0.3), end])
    corners = [(x, y, z) for y in (0.0, 1.0) for x, z in profile]
    found = map_of(families.polygons(corners, [(k, k + 1, k + 5, k + 4) for k in range(3)])).verdict
    assert ("folded over itself" in found.sentence) == is_folded


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
    assert found == report["components"][0]["main_map"]["verdict"]
    assert (ended, Verdict(**found).is_fit) == (status, False)
    assert told == (f"holomorph: {found['sentence']}\n" if strict else "")


def test_strict_takes_what_is_good(tmp_path, capsys):
    path = file_of(families.torus(48, 24), tmp_path / "torus.obj")
    status, report, told = run(capsys, path, "--strict", "--main", "automatic")
    assert (status, report["verdict"]["level"], told) == (0, "fair", "")


def test_strict_wants_every_part(tmp_path, capsys):
    flat = families.moved(families.tetrahedron(), scale=0)
    path = file_of(families.united(families.torus(24, 12), flat), tmp_path / "two.obj")
    assert run(capsys, path)[0] == 0
    status, _, told = run(capsys, path, "--strict")
    assert status == 3 and told.startswith("holomorph: 1 of 2 parts have no map: ")
