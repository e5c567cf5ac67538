"""Which map a part gets: by itself, in the command, and beside other parts."""

import json
import math

import families
import holomorph
import numpy as np
import pytest
from families import cylinder, geodesic_sphere, hemisphere, torus, united
from holomorph.__main__ import main
from holomorph.quality.quality import Quality
from holomorph.tiling.request import EVENNESS

SHARED = {"hand": "hand_lowres_b1.obj", "pretzel": "double-torus.obj"}
FAMILIES = {
    "torus": lambda: torus(24, 12),
    "tube": lambda: cylinder(16, 24),
    "sphere": lambda: geodesic_sphere(6),
    "disk": lambda: hemisphere(8),
    "two parts": lambda: united(torus(24, 12, R=3.0), torus(24, 12)),
}


def surface_of(mesh):
    return holomorph.Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


@pytest.fixture(params=[*FAMILIES, *SHARED])
def mesh_file(request, tmp_path):
    """A mesh of a family, or a real one, as a file."""
    if request.param in SHARED:
        return request.getfixturevalue("meshes") / SHARED[request.param]
    path = tmp_path / "mesh.obj"
    surface = surface_of(FAMILIES[request.param]())
    surface.write(path)
    return path


def test_the_command_gives_the_same_map(mesh_file, tmp_path):
    """Its UVs are those of `automatic_maps`, side by side, to the last bit; so are kind and reason."""
    surface = holomorph.Surface.read(mesh_file)
    made = holomorph.automatic_maps(surface)
    output, report = tmp_path / "mapped.obj", tmp_path / "report.json"
    assert main([str(mesh_file), "--output", str(output), "--report", str(report)]) == 0
    texts = [line.split()[1:] for line in output.read_text().splitlines() if line.startswith("vt ")]
    own = holomorph.arrangement.arranged(made, len(surface.corner_vertices))
    assert np.array_equal(np.unique(np.array(texts, float), axis=0), np.unique(own, axis=0))
    said = [part["main_map"] for part in json.loads(report.read_text())["components"]]
    assert [(m["kind"], m["why"]) for m in said] == [(m.kind, m.why) for m in made]


@pytest.mark.parametrize("name", FAMILIES)
def test_a_part_alone_gets_the_map_that_it_gets_beside_others(name):
    surface = surface_of(FAMILIES[name]())
    made, density = holomorph.automatic_maps(surface), None
    for part, found in sorted(zip(surface.components, made), key=lambda pair: -pair[0].area):
        alone = holomorph.automatic_map(part, density=density)
        assert np.array_equal(alone.uv, found.uv) and alone.kind == found.kind
        density = density or (alone.density if alone.tiling else None)


def test_what_was_solved_is_taken():
    surface = surface_of(torus(24, 12))
    structure = holomorph.conformal_structure(surface)
    options = {"main": "seamless", "poles": 4}
    made = [holomorph.automatic_map(surface, given, **options) for given in (structure, None)]
    assert made[0].structure is structure and np.array_equal(made[0].uv, made[1].uv)
    stages = []
    holomorph.automatic_map(
        surface, structure, tiles=40, **options, progress=lambda _fraction, stage: stages.append(stage)
    )
    assert "search for poles" not in stages  # they were placed


@pytest.mark.parametrize("name", FAMILIES)
def test_the_balanced_map_is_that_of_the_structure(name):
    for part in surface_of(FAMILIES[name]()).components:
        found = holomorph.automatic_map(part, main="balanced", evenness=0)
        assert found.tiling is None and found.kind == found.structure.map_kind
        assert np.array_equal(found.uv, found.structure.uv(found.coefficients))
        assert np.array_equal(found.seams, found.structure.edges[found.structure.seams])


def test_what_is_flat_or_unfolds_gets_its_flat_map_where_no_tiling_is_wanted():
    made = holomorph.automatic_map(surface_of(families.saw_blade()), main="untiled")
    assert made.kind == "flat" and made.quality.density_ratio == pytest.approx(1) and made.quality.lost_part == 0
    assert holomorph.automatic_map(surface_of(families.cube()), main="untiled").kind == "islands"


@pytest.mark.parametrize("name", FAMILIES)
def test_the_best_other_map_is_no_tiling(name):
    for part in surface_of(FAMILIES[name]()).components:
        found = holomorph.automatic_map(part, main="untiled")
        assert found.tiling is None and found.evenness == EVENNESS and math.isfinite(found.quality.mean_angle)


def test_a_part_without_islands_gets_another_map():
    """A tube with a rim of no width, as skins are closed with needles: its islands collapse."""
    mesh = cylinder(16, 24)
    rim = np.flatnonzero(mesh.vertices[:, 2] == mesh.vertices[:, 2].max())
    rim = rim[np.argsort(np.arctan2(*mesh.vertices[rim, 1::-1].T))]
    again = len(mesh.vertices) + np.arange(len(rim))
    quads = np.stack([rim, np.roll(rim, -1), np.roll(again, -1), again], axis=1)
    faces = np.split(mesh.corners, mesh.offsets[1:-1])
    surface = holomorph.Surface(np.concatenate([mesh.vertices, mesh.vertices[rim]]), [*faces, *quads])
    assert holomorph.island_map(surface) is None
    for wanted in ("automatic", "untiled"):
        assert holomorph.automatic_map(surface, main=wanted).islands == 0


def spiky_ball(seed):
    """A ball of few triangles, some of which most conformal maps flip."""
    mesh = geodesic_sphere(2)
    radii = np.exp(np.random.default_rng(seed).normal(size=len(mesh.vertices)))
    return holomorph.Surface.from_polygons(mesh.vertices * radii[:, None], mesh.corners, mesh.offsets)


@pytest.mark.parametrize("seed", range(7))
def test_a_tiling_that_loses_much_is_refused_and_the_best_other_map_is_not(seed):
    surface = spiky_ball(seed)
    structure = holomorph.automatic_structure(surface)
    options = {"main": "seamless", "tiles": 10, "poles": 2, "evenness": 0}
    lost = structure.tile(10, poles=2, direction="upright").quality.lost_part
    if lost < 0.02:
        assert holomorph.automatic_map(surface, structure, **options).quality.lost_part == lost
        return
    with pytest.raises(holomorph.TopologyError, match=f"would lose {100 * lost:.2g} % of its area"):
        holomorph.automatic_map(surface, structure, **options)
    made = holomorph.automatic_map(surface, structure, **(options | {"main": "automatic"}))
    assert not made.tiling and made.quality.lost_part < 0.02


def test_kinds():
    kinds = [holomorph.automatic_map(surface_of(FAMILIES[name]()), main="balanced").kind for name in list(FAMILIES)[:4]]
    assert kinds == ["forms", "strip", "log", "disk"]


def test_a_tiling_that_is_asked_for_and_cannot_be_made_is_an_error_of_its_part():
    parts = surface_of(FAMILIES["two parts"]()).components
    with pytest.raises(holomorph.TopologyError, match="max_added"):
        holomorph.automatic_map(parts[1], main="seamless", tiles=3, poles=2, max_added=1.0)
    made = holomorph.automatic_maps(parts, main=["balanced", "seamless"], tiles=3, poles=2, max_added=1.0)
    assert isinstance(made[0], holomorph.Map) and "max_added" in str(made[1])
    (stays,) = holomorph.automatic_maps(parts[1:], tiles=3, poles=2, max_added=1.0)
    assert stays.tiling is None and "max_added" in stays.why


def test_tilings_have_one_density():
    parts = surface_of(FAMILIES["two parts"]()).components
    for options in ({"tiles": 400.0}, {"density": 5.0}):
        made = holomorph.automatic_maps(parts, main="seamless", **options)
        assert all(m.tiling for m in made)
        assert made[0].density == pytest.approx(made[1].density, rel=0.1)
        if "tiles" in options:
            assert sum(m.density * part.area for m, part in zip(made, parts)) == pytest.approx(400.0, rel=0.1)


@pytest.mark.parametrize("tiles", [60, 80, 100, 120, 140, 160])
@pytest.mark.parametrize("radii", [(2, 1), (3, 0.6), (2, 0.5), (4, 1.2)])
def test_a_single_part_rather_misses_a_density_than_has_seams(radii, tiles):
    surface = surface_of(families.torus(36, 20, R=radii[0], r=radii[1]))
    wanted = tiles / surface.area
    made = holomorph.automatic_map(surface, density=wanted)
    assert made.kind == "tiling" and abs(made.density / wanted - 1) <= 0.2


def test_a_part_on_which_whole_tiles_are_too_few_has_the_same_density_without():
    parts = surface_of(united(torus(24, 12, R=3.0), torus(24, 12, R=0.3, r=0.1))).components
    made = holomorph.automatic_maps(parts, main="seamless", tiles=40)
    assert made[0].tiling and not made[1].tiling and "tiles" in made[1].why
    corners = sum(len(part.corner_vertices) for part in parts)
    uv = holomorph.arrangement.arranged(made, corners)
    found = [Quality.of(part._native, np.ascontiguousarray(uv[part.corner_index]), 0) for part in parts]
    rounding = (
        np.spacing(np.float32(uv.max())) / np.ptp(uv[parts[1].corner_index], axis=0).min()
    )  # the part has 24 by 12 quads
    assert found[0].median_density == pytest.approx(found[1].median_density, rel=24 * rounding)


def test_the_density_of_tiles_is_one_or_the_other():
    parts = surface_of(FAMILIES["two parts"]()).components
    with pytest.raises(ValueError, match="not both"):
        holomorph.automatic_maps(parts, tiles=3, density=2.0)


def test_upright():
    """Rows run level: on a tube that stands, v runs up."""
    tube, ring = surface_of(cylinder(24, 12)), surface_of(torus(24, 12))
    found = holomorph.automatic_map(tube, main="seamless", poles=0)
    height, v = tube.vertices[tube.corner_vertices, 2], found.uv[:, 1]
    assert np.corrcoef(height, v)[0, 1] > 1 - 1e-9
    along = {"direction": (0, 0, 1), "turn": np.pi / 2}
    made = [
        holomorph.automatic_map(ring, main="seamless", **options).uv for options in ({}, along, {"direction": None})
    ]
    assert np.array_equal(made[0], made[1]) and not np.array_equal(made[0], made[2])
    with pytest.raises(ValueError, match="direction is 'up'"):
        holomorph.automatic_map(tube, main="seamless", direction="up")


def test_an_intrinsic_surface_has_no_upright():
    surface = surface_of(torus(24, 12))
    points = surface.vertices[surface.triangles]
    lengths = np.linalg.norm(np.roll(points, -1, axis=1) - np.roll(points, -2, axis=1), axis=2)
    intrinsic = holomorph.Surface.from_edge_lengths(surface.triangles, lengths)
    made = [holomorph.automatic_map(intrinsic, main="seamless", direction=d).uv for d in ("upright", None)]
    assert np.array_equal(*made)


def test_vertices_are_those_of_the_surface_with_isolated_ones():
    mesh = torus(24, 12)
    shifted = holomorph.Surface.from_polygons(
        np.concatenate([np.zeros((5, 3)), mesh.vertices]), mesh.corners + 5, mesh.offsets
    )
    plain = surface_of(mesh)
    for main_map in ("seamless", "balanced"):
        one = holomorph.automatic_map(plain, main=main_map, poles=[7, 200])
        other = holomorph.automatic_map(shifted, main=main_map, poles=[12, 205])
        assert np.array_equal(one.uv, other.uv)
        assert np.array_equal(one.seams + 5, other.seams) and np.array_equal(one.poles + 5, other.poles)


@pytest.mark.parametrize("name", [*FAMILIES, "knot", "washer", "cube", "thick torus", "bowl"])
def test_no_other_map_costs_less(name):
    more = {
        "knot": lambda: families.torus_knot(100, 8),
        "washer": lambda: families.washer(20),
        "cube": families.cube,
        "thick torus": lambda: torus(30, 20, R=1.5),
        "bowl": lambda: hemisphere(5),
    }
    for part in surface_of((FAMILIES | more)[name]()).components:
        least = holomorph.automatic_map(part).cost
        for wanted in ("seamless", "untiled", "balanced"):
            try:
                other = holomorph.automatic_map(part, main=wanted)
            except holomorph.TopologyError:
                continue
            assert least <= other.cost + 1e-9, wanted


def test_unknown_main_map():
    with pytest.raises(ValueError, match="main is 'best'; one of automatic, seamless, untiled, balanced"):
        holomorph.automatic_map(surface_of(torus(24, 12)), main="best")
