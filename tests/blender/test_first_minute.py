"""What is seen after the button: the viewport, the verdict in words, coarse places and the button for poles there."""

from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from drawn_panel import drawn
from loaded_addon import module
from scenes import everything, mesh_io, mesh_object, run, select, shown_scale, sphere_arrays, stored_report, torus, uv

report, lines, viewport = map(module, ("results.report", "interface.lines", "materials.material"))


def spikes(subdivisions=4):
    """A ball with three spikes; the log map has its poles in two of them."""
    vertices, faces = sphere_arrays(subdivisions)
    vertices = np.array(vertices)
    factor = 1 + 6 * np.exp(-24 * (0.5 - vertices.max(axis=1)))
    return mesh_object("Spikes", vertices * factor[:, None], faces)


# ---- the viewport -------------------------------------------------------------------------------------------------


@pytest.fixture
def views():
    """A window, and the shading of its 3D views; as they were before afterwards."""
    window = bpy.context.window_manager.windows[0]
    shadings = [a.spaces.active.shading for a in window.screen.areas if a.type == "VIEW_3D"]
    before = [(shading.type, shading.color_type) for shading in shadings]
    yield window, shadings
    for shading, (kind, colour) in zip(shadings, before):
        shading.type = "SOLID"
        shading.color_type = colour
        shading.type = kind
    window.screen.pop(viewport.SHADING_BEFORE, None)


@pytest.mark.parametrize("kind", ["SOLID", "WIREFRAME"])
@pytest.mark.parametrize("colour", ["MATERIAL", "OBJECT"])
def test_a_view_without_textures_shows_them_and_goes_back(views, kind, colour):
    window, (shading, *_) = views
    shading.type, shading.color_type = "SOLID", colour
    shading.type = kind
    viewport.show_in_views(window)
    viewport.show_in_views(window)
    assert (shading.type, shading.color_type) == ("SOLID", "TEXTURE")
    viewport.restore_views(window)
    kept, shading.type = shading.type, "SOLID"
    assert (kept, shading.color_type) == (kind, colour)
    assert viewport.SHADING_BEFORE not in window.screen


@pytest.mark.parametrize(("kind", "colour"), [("MATERIAL", "MATERIAL"), ("SOLID", "TEXTURE")])
def test_a_view_that_shows_textures_stays(views, kind, colour):
    window, (shading, *_) = views
    shading.type, shading.color_type = kind, colour
    viewport.show_in_views(window)
    assert shading.type == kind and viewport.SHADING_BEFORE not in window.screen


def test_shading_that_was_chosen_since_is_kept(views):
    window, (shading, *_) = views
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    viewport.show_in_views(window)
    shading.type = "MATERIAL"
    viewport.restore_views(window)
    assert shading.type == "MATERIAL" and viewport.SHADING_BEFORE not in window.screen


@pytest.mark.parametrize("back", [bpy.ops.uv.holomorphic_restore_materials, bpy.ops.uv.holomorphic_remove_maps])
def test_the_operator_shows_and_what_takes_the_texture_away_restores(views, back):
    window, (shading, *_) = views
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    first, second = torus("First"), torus("Second")
    select(first, second)
    with bpy.context.temp_override(window=window):
        run()
        assert shading.color_type == "TEXTURE"
        select(first)
        back()
        assert shading.color_type == "TEXTURE"  # the other object still has its checker
        select(second)
        back()
    assert shading.color_type == "MATERIAL"


@pytest.mark.parametrize("is_on", [True, False])
def test_the_preference_decides(views, is_on):
    window, (shading, *_) = views
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    package = module("preferences").__package__
    addons = {package: SimpleNamespace(preferences=SimpleNamespace(show_in_viewport=is_on))}
    context = SimpleNamespace(window=window, preferences=SimpleNamespace(addons=addons))
    module("operators.mixins").WorkOperator().show(context, SimpleNamespace(done=["Ring"]), True)
    assert shading.color_type == ("TEXTURE" if is_on else "MATERIAL")


def test_without_a_texture_the_view_stays(views):
    window, (shading, *_) = views
    shading.type, shading.color_type = "SOLID", "MATERIAL"
    torus()
    with bpy.context.temp_override(window=window):
        run(checker=False)
    assert shading.color_type == "MATERIAL"


# ---- words and numbers --------------------------------------------------------------------------------------------


def test_an_even_map_is_called_so_in_a_line():
    obj = torus()
    run(main="SEAMLESS")
    layout = drawn(obj)
    assert layout.texts[0] == "Ready to tile" and ", seamless" in layout.texts[1]
    assert "Not ready to bake" in layout.texts and layout.buttons == ["object.holomorphic_bake"]
    entry = stored_report(obj)
    assert entry["verdict"]["level"] in ("good", "fair")
    flipped = entry["components"][0]["main_map"]["flipped_triangles"]
    assert f"Flipped triangles\t{flipped}" in obj.holomorph_map.made.numbers.splitlines()


@pytest.mark.parametrize("edit", ["move", "delete"])
def test_after_an_edit_the_verdict_is_marked_as_of_before(edit):
    obj = torus()
    run(main="SEAMLESS")
    assert not report.is_edited(obj)
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    edited.faces.ensure_lookup_table()
    if edit == "move":
        edited.faces[5].verts[0].co.x += 0.1
    else:
        bmesh.ops.delete(edited, geom=edited.faces[:1], context="FACES")
    edited.to_mesh(obj.data)
    edited.free()
    assert report.is_edited(obj)
    layout = drawn(obj, is_edited=True)
    assert layout.texts[0].startswith("Before the") and "CHECKMARK" not in layout.icons


def test_the_kinds_of_parts_are_told():
    vertices, faces = sphere_arrays(4)
    count = len(vertices)
    flat = [(5, 0, 0), (6, 0, 0), (6, 1, 0), (5, 1, 0)]
    obj = mesh_object("Two", [*map(tuple, vertices), *flat], [*faces, tuple(range(count, count + 4))])
    run(main="AUTOMATIC")
    kinds = [part["main_map"]["kind"] for part in stored_report(obj)["components"]]
    assert len(set(kinds)) == 2
    (told,) = [text for text in drawn(obj, 1000).texts if text.startswith("2 parts: 1 ")]
    assert "1 flat" in told


def test_vertices_that_were_joined_are_told_and_not_offered_to_be_merged():
    """The map is that of the merged mesh already, of one that counts vertices in the same order."""
    vertices, faces = sphere_arrays(4)
    corners = np.concatenate([list(face) for face in faces])
    ends = np.cumsum([len(face) for face in faces])
    apart = [tuple(range(end - len(face), end)) for face, end in zip(faces, ends)]
    obj = mesh_object("Apart", np.array(vertices)[corners], apart)
    layout, joined = drawn_after_run(obj), stored_report(obj)["whole"]["cost"]
    assert any(f"{len(corners) - len(vertices):,} vertices joined" in text for text in layout.texts)
    assert bpy.ops.mesh.holomorphic_repair(kinds={"WELD"}) == {"FINISHED"}
    assert len(obj.data.vertices) == len(vertices)
    kept, first = np.unique(corners, return_index=True)
    order = kept[np.argsort(first)]
    merged = mesh_object("Merged", np.array(vertices)[order], np.argsort(order)[np.array(faces)])
    drawn_after_run(merged)
    assert stored_report(merged)["whole"]["cost"] == pytest.approx(joined)


def drawn_after_run(obj):
    select(obj)
    run(main="AUTOMATIC")
    return drawn(obj, 1000)


def test_warnings_of_one_kind_are_one_line():
    parts = [SimpleNamespace(skipped="no room", component=SimpleNamespace(note=""), not_seamless="")] * 239
    left_out = [SimpleNamespace(faces=[1], reason="without area")] * 7
    made = SimpleNamespace(parts=parts, solved=SimpleNamespace(surface=SimpleNamespace(refused=left_out)))
    told = list(module("results.write")._problems(SimpleNamespace(name="Kit"), made))
    assert told == ["Kit: 239 parts of 239 skipped: no room", "Kit: 7 faces left out: without area"]


def test_lines_are_broken_where_they_do_not_fit():
    def is_fit(text):
        return len(text) <= 12

    assert list(lines.broken("Even, seamless, 8 poles", is_fit)) == ["Even,", "seamless, 8", "poles"]
    assert list(lines.broken("    modulus indescribable 2", is_fit, indent=2)) == [
        "    modulus",
        "  indescribable",
        "  2",
    ]
    assert list(lines.broken("", is_fit)) == [""]


RING = "Ring: To tile: even. To bake: nothing overlaps"


@pytest.mark.parametrize(("level", "told"), [("fair", ([], [RING])), ("poor", ([RING], []))])
def test_a_poor_map_is_a_warning(level, told):
    outcome = module("results.write").Outcome()
    said = {"verdict": {"level": level, "sentence": "Even"}, "bake": {"level": "good", "sentence": "Nothing overlaps"}}
    entry = said | {"components": [], "faces_without_area": 0, "whole": {"text": ""}}
    outcome.judge(SimpleNamespace(name="Ring"), SimpleNamespace(parts=[]), entry)
    assert (outcome.problems, outcome.notes) == told


def test_a_narrow_panel_has_more_lines_of_the_same_words():
    obj = spikes()
    run()
    narrow, wide = drawn(obj, 180).texts, drawn(obj, 1000).texts
    assert len(narrow) > len(wide) and " ".join(narrow).split() == " ".join(wide).split()


def spiked(obj, place):
    """(which of the axes a place's vertex is on, its distance from the centre) of the ball with spikes."""
    point = np.array(obj.data.vertices[place["vertex"]].co)
    return int(np.argmax(point)), np.linalg.norm(point)


def test_a_spike_without_a_pole_is_coarse_and_named():
    obj = spikes()
    run()
    entry = stored_report(obj)
    assert entry["verdict"]["level"] in ("poor", "unusable")
    (place,) = entry["coarse_places"]
    axis, distance = spiked(obj, place)
    assert place["name"] == ("the +X side", "the back", "the top")[axis] and distance > 3 and place["times"] > 4


def test_a_place_has_the_name_of_its_vertex_group():
    obj = spikes()
    for axis, name in enumerate("XYZ"):
        group = obj.vertex_groups.new(name=f"arm.{name}")
        group.add([v.index for v in obj.data.vertices if v.co[axis] > 1], 1.0, "ADD")
    run()
    (place,) = stored_report(obj)["coarse_places"]
    assert place["name"] == f"arm.{'XYZ'[spiked(obj, place)[0]]}"
    place["name"] = "arm.L"
    assert report.coarse_sentence([place | {"times": 40.2}]) == "Arm.L is 40 times coarser than the rest"
    assert report.coarse_sentence([place | {"times": 999}] * 3).startswith("Arm.L and 2 more places are over 200 times")


def test_faces_that_single_precision_loses_are_told():
    """The density falls along a spike by the power of its length."""
    obj = spikes(5)
    for vertex in obj.data.vertices:
        vertex.co = [x + 60 * max(x - 1, 0) for x in vertex.co]
    run(evenness=0.0)
    entry = stored_report(obj)
    lost, double = entry["faces_without_area"], entry["components"][0]["main_map"]["collapsed_triangles"]
    assert lost > double == 0


def test_the_button_puts_poles_where_it_is_coarse():
    obj = spikes()
    run()
    layout = drawn(obj)
    assert layout.buttons == ["Try Points There"]
    assert vars(layout.calls[0][1]) == {"poles": "COARSE", "is_trial": True}
    bpy.ops.uv.holomorphic_tile(poles="COUNT", pole_count=2, evenness=0)
    before = stored_report(obj)
    places, poles = before["coarse_places"], before["components"][0]["tiling"]["poles"]
    bpy.ops.uv.holomorphic_tile(poles="COARSE", evenness=0)
    after = stored_report(obj)["components"][0]
    made = set(after["tiling"]["poles"])  # a pole whose residue is rounded to 0 is none
    assert len(places) > 0 and len(made) > 2 and made <= {*poles, *(place["vertex"] for place in places)}
    assert after["main_map"]["size_range"] < before["components"][0]["main_map"]["size_range"]


@pytest.mark.parametrize("is_better", [True, False])
def test_poles_that_are_tried_stay_where_the_map_costs_an_eye_less(is_better):
    obj = spikes()
    run()
    cost = stored_report(obj)["whole"]["cost"]
    if not is_better:
        obj.holomorph_map.made.cost = 0.0
    before = everything(obj)
    if is_better:
        assert bpy.ops.uv.holomorphic_tile(poles="COARSE", is_trial=True) == {"FINISHED"}
        assert stored_report(obj)["whole"]["cost"] < cost
    else:
        with pytest.raises(RuntimeError, match="Spikes: it would be no better: .*the map stays as it is"):
            bpy.ops.uv.holomorphic_tile(poles="COARSE", is_trial=True)
        assert everything(obj) == before and bpy.ops.uv.holomorphic_tile(poles="COARSE") == {"FINISHED"}


def test_poles_are_off_the_boundary():
    """A half of the ball with spikes, cut through the spike that is coarse."""
    obj = spikes()
    run()
    (place,) = stored_report(obj)["coarse_places"]
    axis, _ = spiked(obj, place)
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    plane = {"plane_co": (0.3,) * 3, "plane_no": np.eye(3)[axis - 1] - np.eye(3)[axis - 2]}
    bmesh.ops.bisect_plane(bm, geom=[*bm.verts, *bm.edges, *bm.faces], clear_outer=True, **plane)
    vertices = np.array([v.co for v in bm.verts])
    polygons = mesh_io.read_polygons(as_mesh(bm), np.eye(3))
    on_plane = np.abs((vertices - 0.3) @ plane["plane_no"]) < 1e-5
    assert 0 < on_plane.sum() < len(vertices)
    fine = np.zeros((len(polygons.corner_vertices), 2))
    fine[:] = polygons.vertices[polygons.corner_vertices][:, [axis - 1, axis - 2]]
    is_far = polygons.vertices[polygons.corner_vertices, axis] > 1.5
    octaves = module("native").load().distortion.measure(polygons, np.where(is_far[:, None], 0.01 * fine, fine)).density
    found = report.coarse_places(obj, polygons, octaves)
    assert found and not any(on_plane[place["vertex"]] for place in found)


def as_mesh(bm):
    mesh = bpy.data.meshes.new("Half")
    bm.to_mesh(mesh)
    bm.free()
    return mesh


def test_a_map_without_a_tiling_gets_its_poles_by_itself():
    obj = spikes()
    run()
    bpy.ops.uv.holomorphic_tile(poles="COARSE")
    assert stored_report(obj)["verdict"]["level"] in ("good", "fair") and np.isfinite(uv(obj)).all()


# ---- dials that do something ----------------------------------------------------------------------------------------


def test_a_higher_density_shows_more_squares_where_their_number_is_chosen():
    obj = torus()
    run()
    squares, side = shown_scale(obj), np.ptp(uv(obj), axis=0)
    run(density=2.0)
    assert shown_scale(obj) == squares and np.allclose(np.ptp(uv(obj), axis=0), 2 * side, rtol=1e-5)


# ---- maps of someone else -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("press", [run, bpy.ops.uv.holomorphic_tile])
def test_maps_with_our_names_that_are_not_ours_are_kept(press):
    obj = torus()
    for name in ("Holomorphic 2", "Holomorphic"):
        obj.data.uv_layers.new(name=name)
    own = [uv(obj, name) for name in ("Holomorphic 2", "Holomorphic")]
    for _ in range(2):
        press()
        names = [layer.name for layer in obj.data.uv_layers]
        assert names[:2] == ["Holomorphic 2", "Holomorphic"] and names[2] == "Holomorphic.001"
        assert len(names) == (4 if press is run else 3) and obj.data.uv_layers.active.name == "Holomorphic.001"
    assert all(np.array_equal(uv(obj, name), values) for name, values in zip(names, own))


def test_a_map_of_ours_that_was_renamed_is_kept():
    obj = torus()
    run()
    obj.data.uv_layers["Holomorphic"].name = "Mine"
    run()
    assert [layer.name for layer in obj.data.uv_layers] == ["Mine", "Holomorphic", "Holomorphic 1"]
