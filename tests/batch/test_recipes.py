"""What a recipe asks for is what an asset gets, as the package itself makes it."""

import json
from dataclasses import fields
from itertools import product

import holomorph
import numpy as np
import pytest
from batch_runs import run, torus_obj
from holomorph.batch import UsageError, mapping, recipe


@pytest.fixture(scope="module")
def torus(tmp_path_factory):
    return holomorph.Surface.read(torus_obj(tmp_path_factory.mktemp("torus") / "torus.obj"))


def two_parts(surface, apart=10.0):
    """The surface and a copy of it, as one."""
    count, corners = len(surface.vertices), np.asarray(surface.corner_vertices)
    vertices = np.concatenate([surface.vertices, surface.vertices + [apart, 0, 0]])
    offsets = np.concatenate([surface.face_offsets, surface.face_offsets[1:] + len(corners)])
    return holomorph.Surface.from_polygons(vertices, np.concatenate([corners, corners + count]), offsets)


def mapped(surface, **tables):
    wanted = recipe.of(tables)
    parts = mapping.map_parts(surface, wanted)
    return parts, mapping.main_uv(surface, parts, wanted.maps)


def jumps(surface, uv):
    """(n, 2) differences of the UVs on both sides of the edges where they differ, at both ends."""
    corners, offsets = np.asarray(surface.corner_vertices), np.asarray(surface.face_offsets)
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    edges = {(corners[c], corners[following[c]]): c for c in range(len(corners))}
    sides = [(c, edges[end, start]) for (start, end), c in edges.items() if (end, start) in edges]
    one, other = np.array(sides).T
    found = np.concatenate([uv[one] - uv[following[other]], uv[following[one]] - uv[other]])
    return found[np.abs(found).max(axis=1) > 1e-9]


def test_seamless_parts_keep_whole_tiles_side_by_side(torus):
    """Two parts, each moved by whole units, and apart from each other."""
    surface = two_parts(torus)
    parts, uv = mapped(surface, maps={"main": "seamless"}, tiling={"tiles": 64, "poles": 0})
    assert all(part.map.tiling for part in parts)
    found = jumps(surface, uv)
    assert len(found) and np.abs(found - np.rint(found)).max() < 1e-9
    boxes = [(uv[half].min(axis=0), uv[half].max(axis=0)) for half in np.split(np.arange(len(uv)), 2)]
    (low, high), (other_low, other_high) = boxes
    assert (high <= other_low + 1e-9).any() or (other_high <= low + 1e-9).any()


def test_density_of_a_tiling(torus):
    """Tiles per unit of area: the same for both parts."""
    parts, _ = mapped(two_parts(torus), maps={"main": "seamless"}, tiling={"density": 2.0, "poles": 0})
    for part in parts:
        assert part.map.tiling and part.map.density == pytest.approx(2.0, rel=0.1)


def test_a_tiling_is_compared_where_the_map_is_uneven_or_has_seams(torus):
    """A slender torus is even by itself, and becomes seamless without poles."""
    radius = np.linalg.norm(torus.vertices[:, [0, 2]], axis=1)
    slender = torus.vertices * np.stack([1 + 18 / radius, np.ones_like(radius), 1 + 18 / radius], axis=1)
    even = holomorph.Surface.from_polygons(slender, torus.corner_vertices, torus.face_offsets)
    (part,), _ = mapped(even)
    assert len(part.map.tiling.poles) == 0 and part.map.quality.density_ratio < 2
    (balanced,), _ = mapped(torus, maps={"main": "balanced"})
    assert balanced.map.tiling is None and balanced.map.quality.density_ratio > 2


def test_the_map_is_the_automatic_one(torus):
    for surface in (torus, two_parts(torus)):
        parts, _ = mapped(surface)
        for part, made in zip(parts, holomorph.automatic_maps(surface), strict=True):
            assert np.array_equal(part.map.uv, made.uv) and part.map.why == made.why


def test_a_map_that_is_chosen_is_balanced(torus):
    """Unless a tiling is asked for."""
    for maps in ({"rotation": 30.0}, {"density": 2.0}, {"poles": [5, 150]}, {"solver": "paper"}):
        (part,), _ = mapped(torus, maps=maps)
        assert part.map.tiling is None
        (part,), _ = mapped(torus, maps=maps | {"main": "seamless"})
        assert part.map.tiling is not None


def test_thresholds_of_the_papers_solver(torus):
    for thresholds in ([], [200], None):
        maps = {"solver": "paper"} | ({} if thresholds is None else {"thresholds": thresholds})
        (part,), _ = mapped(torus, maps=maps)
        made = holomorph.conformal_structure(torus, solver="paper", thresholds=thresholds)
        assert [level[:2] for level in part.structure.solver.levels] == [level[:2] for level in made.solver.levels]


def test_direction_of_the_rows(torus):
    """The axis of this torus is Y: with rows along it, u runs where v runs with upright ones by another axis."""
    ways = {"upright": "upright", "none": None, (0.0, 0.0, 1.0): (0.0, 0.0, 1.0)}
    for written, direction in ways.items():
        value = list(written) if isinstance(written, tuple) else written
        (part,), _ = mapped(torus, maps={"main": "seamless"}, tiling={"direction": value})
        made = holomorph.automatic_map(torus, main="seamless", direction=direction)
        assert np.array_equal(part.map.uv, made.uv)


def test_poles_of_the_part_they_lie_on(torus):
    surface = two_parts(torus)
    count = len(torus.vertices)
    parts, _ = mapped(surface, maps={"main": "balanced", "poles": [count + 5, count + 150]})
    assert isinstance(parts[0].structure, holomorph.ConformalStructure)
    assert parts[1].structure.poles.tolist() == [5, 150]
    with pytest.raises(holomorph.TopologyError, match=f"vertex {2 * count}, which the recipe chooses"):
        mapped(surface, maps={"poles": [2 * count]})


def test_residues_in_the_order_of_the_poles(torus):
    maps = {"main": "balanced", "poles": [150, 5], "residues": [[0, 1], [0, -1]]}
    (part,), _ = mapped(torus, maps=maps)
    assert part.structure.poles.tolist() == [150, 5]
    assert part.structure.residues.tolist() == [1j, -1j]


def test_balanced_parts_have_one_density_in_the_square(torus):
    surface = two_parts(torus)
    parts, uv = mapped(surface, maps={"main": "balanced", "margin": 0.1})
    assert uv.min() >= -1e-9 and uv.max() <= 1 + 1e-9
    halves = np.split(uv, 2)
    densities = [part.structure.quality(half).median_density for part, half in zip(parts, halves)]
    assert densities[0] == pytest.approx(densities[1], rel=1e-9)
    (low, high), (other_low, other_high) = [(half.min(axis=0), half.max(axis=0)) for half in halves]
    gap = np.maximum(other_low - high, low - other_high).max()
    assert gap == pytest.approx(0.1, rel=0.2)


def test_a_turned_map_is_turned(torus):
    """Angles stay, and so does the square."""
    (part,), plain = mapped(torus, maps={"main": "balanced"})
    _, turned = mapped(torus, maps={"main": "balanced", "rotation": 30.0})
    z, w = (uv[:, 0] + 1j * uv[:, 1] for uv in (plain, turned))
    apart = np.abs(z - z[0]) > 0.01
    assert np.angle((w - w[0])[apart] / (z - z[0])[apart]) == pytest.approx(np.pi / 6, abs=1e-9)
    assert turned.min() >= -1e-9 and turned.max() <= 1 + 1e-9
    assert part.structure.quality(turned).mean_angle == pytest.approx(part.map.quality.mean_angle, rel=1e-9)


def test_shape_of_a_sphere_and_of_a_disk(tmp_path):
    """On the unit sphere and in the unit disk."""
    (tmp_path / "cube.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    )
    u, v = np.meshgrid(np.arange(5), np.arange(5), indexing="ij")
    faces = np.stack([u * 5 + v + 1, u * 5 + v + 2, u * 5 + v + 7, u * 5 + v + 6], axis=-1)[:-1, :-1].reshape(-1, 4)
    points = "".join(f"v {x} {y} 0\n" for x in range(5) for y in range(5))
    (tmp_path / "disk.obj").write_text(points + "f %d %d %d %d\n" * len(faces) % tuple(faces.ravel().tolist()))
    (tmp_path / "recipe.toml").write_text("[maps]\nmain = 'balanced'\nshape = true\npoles = [12]\n")
    (tmp_path / "plain.toml").write_text("[maps]\nmain = 'balanced'\nshape = true\n")
    for name, wanted, height in (("cube", "plain", 1.0), ("disk", "recipe", 0.0)):
        out = tmp_path / name
        result = run(tmp_path / f"{name}.obj", "--out", out, "--recipe", tmp_path / f"{wanted}.toml", "--workers", 1)
        assert result.returncode == 0, result.stderr
        shape = np.load(out / f"assets/{name}.obj/mesh.npz")["shape"]
        length = np.linalg.norm(shape, axis=1)
        assert length.max() == pytest.approx(1, rel=1e-9)
        assert np.abs(shape[:, 2]).max() == pytest.approx(height, rel=1e-9, abs=1e-9)


def test_strict(torus, tmp_path):
    """A torus is fit, but not one that is so coarse that it is sheared."""
    good, bad = torus_obj(tmp_path / "good.obj", 40, 20), torus_obj(tmp_path / "bad.obj", 3, 3)
    (tmp_path / "recipe.toml").write_text("[maps]\nmain = 'seamless'\n")
    arguments = ("--recipe", tmp_path / "recipe.toml", "--workers", 1, "--strict")
    assert run(good, "--out", tmp_path / "out", *arguments).returncode == 0
    result = run(good, bad, "--out", tmp_path / "out", *arguments)
    levels = {
        path.parent.name: json.loads(path.read_text())["verdict"]["level"]
        for path in (tmp_path / "out/assets").rglob("report.json")
    }
    assert levels["good.obj"] in ("good", "fair") and levels["bad.obj"] in ("poor", "unusable")
    assert result.returncode == 3 and result.stderr.endswith("the first is bad.obj\n")


BOMBS = {
    "lists in lists": ("[maps]\nthresholds = " + "[" * 100_000, "nested more than 8 deep"),
    "tables in tables": ("a = " + "{a=" * 5000, "nested more than 8 deep"),
    "a long name": ("a" + ".a" * 100_000 + " = 1", "nested more than 8 deep"),
    "a long header": ("[" + "a." * 100_000 + "a]", "nested more than 8 deep"),
    "a long word": ("x" * 200_000 + " = 1", "is not a table"),
    "quotes": ("'''a" * 50_000, "not TOML"),
    "more quotes": ('x="""' * 20_000, "not TOML"),
    "many tables": ("".join(f"[a.b{k}]\n" for k in range(20_000)), "is not a table"),
    "400 digits": ("[maps]\nrotation = " + "9" * 400, "maps.rotation is 9999"),
    "9000 digits": ("[maps]\nrotation = " + "9" * 9000, "not TOML"),
    "hexadecimal digits": ("[maps]\nrotation = 0x" + "f" * 100_000, "beyond printing"),
    "a huge exponent": ("[maps]\nrotation = 1e999", "maps.rotation is inf"),
    "no number": ("[maps]\ndensity = nan", "maps.density is nan"),
    "too many poles": ("[tiling]\npoles = 999999999999999999999999999999", "a number up to 1000"),
    "many vertices": ("[maps]\npoles = [" + "1," * 50_000 + "]", "a list of vertices"),
    "many levels": ("[levels]\nlevels = 1000000000", "from 0 to 64"),
    "a long value": ("[maps]\nmain = '" + "x" * 100_000 + "'", "one of automatic"),
    "a large file": ("# " + "x" * 300_000, "at most 262,144"),
    "bytes": (b"\xff\xfe\0\0", "not TOML"),
}


@pytest.mark.parametrize("name", BOMBS)
def test_what_takes_time_or_stack_is_refused_in_one_short_sentence(name, tmp_path):
    content, message = BOMBS[name]
    path = tmp_path / "r.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(UsageError, match=message) as caught:
        recipe.read(path)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < len(str(path)) + 250


def test_names_in_quotes_and_comments_nest_nothing(tmp_path):
    text = '# [[[[[[[[[[ a.b.c.d.e.f.g.h.i.j\n[output]\ntexture = "checker"  # {{{{{{{{{\nformats = ["glb"]\n'
    (tmp_path / "r.toml").write_text(text)
    assert recipe.read(tmp_path / "r.toml").output.formats == ("glb",)


EXTREME = (0, 1, -1, 1e300, 1e-300, 2**31 - 1, 1000, True, "x", [0], [5, 5], [1, 2, 3])


@pytest.mark.parametrize("table", ["maps", "tiling"])
def test_any_value_is_refused_by_name_or_maps_or_leaves_parts_without_one(table, torus):
    """Never another error than ours."""
    kind = type(getattr(recipe.Recipe(), table))
    for name, value in product((option.name for option in fields(kind)), EXTREME):
        try:
            mapped(torus, **{table: {name: value}})
        except (UsageError, holomorph.Error) as error:
            assert 0 < len(str(error)) < 300


def test_maps_turn_as_the_texture_does(tmp_path):
    """The report and the overview tell by what."""
    source = torus_obj(tmp_path / "torus.obj")
    (tmp_path / "recipe.toml").write_text(
        "[maps]\nmain = 'seamless'\n[tiling]\nturns = 'auto'\n[output]\nformats = ['glb']\ntexture = 'checker'\n"
    )
    result = run(source, "--out", tmp_path / "out", "--recipe", tmp_path / "recipe.toml")
    assert result.returncode == 0, result.stderr
    report = json.loads((tmp_path / "out/assets/torus.obj/report.json").read_text())
    cones = len(report["components"][0]["tiling"]["cones"])
    assert report["components"][0]["tiling"]["turns"] == report["texture"]["turns"] == 4
    assert f"seamless tiling, quarter turns, {cones} cones" in (tmp_path / "out/index.html").read_text()


def test_without_a_texture_maps_are_shifted(torus):
    wanted = mapping.turned(recipe.of({"tiling": {"turns": "auto", "lines": "free"}}))[0]
    assert (wanted.tiling.turns, wanted.tiling.lines) == (1, "automatic")
    (part,) = mapping.map_parts(torus, wanted)
    assert part.map.turns == 1


@pytest.mark.parametrize(
    ("tiling", "message"),
    [
        ({"turns": 3}, 'tiling.turns is 3; 1, 2, 4, 6 or "auto" is needed'),
        ({"lines": "all"}, "tiling.lines is 'all'; one of automatic, none, whole, free, mirror is needed"),
        ({"lines": "whole", "turns": 6}, 'tiling.lines = "whole" needs tiling.turns = 2, 4 or "auto"'),
    ],
)
def test_turns_and_lines_are_checked(tiling, message):
    with pytest.raises(UsageError, match=message):
        recipe.of({"tiling": tiling})
