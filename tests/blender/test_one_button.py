"""The main map of the one button: a seamless tiling where that is no less even, with the real library."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    edge_jumps,
    edge_sides,
    everything,
    face_densities,
    fills_the_square,
    grid_arrays,
    limb_arrays,
    mesh_io,
    mesh_object,
    open_example,
    pick,
    select,
    shown_scale,
    stored_report,
    then,
    torus,
    torus_arrays,
    turned_jumps,
    two_parts,
    uv,
    written,
)


def press(**options):
    """The button as it comes: no other dial was ever turned."""
    for obj in bpy.data.objects:
        obj.property_unset("holomorph_map")
    return bpy.ops.uv.holomorphic_maps(**options)


def limb():
    return mesh_object("Limb", *limb_arrays())


def tilings(obj):
    return [part.get("tiling") for part in stored_report(obj)["components"]]


def test_an_uneven_part_becomes_seamless():
    obj = limb()
    assert press(main="BALANCED", evenness=0) == {"FINISHED"}
    before = stored_report(obj)["components"][0]["main_map"]["size_range"]
    assert press() == {"FINISHED"}
    (found,) = tilings(obj)
    assert found["size_range"] < 0.9 * before
    assert [layer.name for layer in obj.data.uv_layers] == ["Holomorphic", "Holomorphic 1"]
    _, whole, off = turned_jumps(obj, found["turns"])
    assert found["turns"] == 4 and off.max() == 0
    assert np.array_equal(whole, np.round(whole)) and np.abs(whole).max() >= 1


def test_the_monkey_is_even():
    """A few triangles of its eyes, where zeros are, have a larger s1 / s2 than all others together."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    assert press() == {"FINISHED"}
    parts = stored_report(obj)["components"]
    head = max(range(len(parts)), key=lambda i: parts[i]["faces"])
    assert parts[head]["main_map"]["size_range"] < 1.73


def is_seamless(obj):
    _, jumps = edge_jumps(obj)
    return np.array_equal(jumps, np.round(jumps)) and np.abs(jumps).max() >= 1


def test_an_even_torus_becomes_seamless_without_poles():
    obj = torus(thickness=0.1, bulge=0)
    press(main="BALANCED", evenness=0)
    before = stored_report(obj)["components"][0]["main_map"]
    assert before["size_range"] < 1.41 and not is_seamless(obj)
    press(texture="BRICKS")
    (found,) = tilings(obj)
    assert found["poles"] == [] and is_seamless(obj)
    assert found["size_range"] < before["size_range"]
    press(texture="BRICKS", evenness=0)
    (found,) = tilings(obj)
    assert found["size_range"] == pytest.approx(before["size_range"], rel=0.01)


def test_a_tube_becomes_seamless_without_poles():
    """The balanced map, scaled: exactly as conformal and as even."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type="NOTHING")
    obj = bpy.context.object
    press(main="BALANCED")
    before = stored_report(obj)["components"][0]["main_map"]
    press()
    (found,), after = tilings(obj), stored_report(obj)["components"][0]["main_map"]
    assert found["poles"] == [] and is_seamless(obj)
    for name in ("size_range", "mean_angle"):
        assert after[name] == pytest.approx(before[name], rel=1e-6)


def test_a_can_has_whole_tiles_around_its_side_and_islands_at_its_ends():
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type="NGON")
    obj = bpy.context.object
    assert press() == {"FINISHED"}
    report = stored_report(obj)
    (part,) = report["components"]
    assert part["main_map"]["kind"] == "mixed" and [found["poles"] for found in part["tilings"]] == [[]]
    assert report["whole"]["text"] == "partly seamless" and report["verdict"]["level"] == "good"
    vertices, jumps = edge_jumps(obj)
    heights = np.array([vertex.co.z for vertex in obj.data.vertices])[vertices]
    side = jumps[heights[:, 0] != heights[:, 1]]  # upright edges
    assert len(side) == 24 and np.array_equal(side, np.round(side)) and np.abs(side).max() >= 1


def test_a_pipe_that_poles_make_no_more_even_has_none():
    open_example("pipe")
    obj = bpy.context.view_layer.objects.active
    press()
    (found,) = tilings(obj)
    assert found["poles"] == [] and is_seamless(obj)


def test_an_even_map_without_seams_stays_what_it_is():
    obj = mesh_object("Grid", *grid_arrays())
    press(evenness=0)
    (part,) = stored_report(obj)["components"]
    assert part["main_map"]["kind"] == "flat" and part["main_map"]["size_range"] < 1.024


def test_a_part_that_a_tiling_makes_no_less_even_becomes_seamless():
    obj = torus(thickness=0.1, bulge=0.22)
    press(evenness=0, texture="NUMBERED")  # which does not turn
    (found,) = tilings(obj)
    assert found["poles"] == [] and found["size_range"] > 1.41
    assert is_seamless(obj)


def test_the_maps_of_the_forms_stay_what_they_are():
    obj = limb()
    press(main="BALANCED")
    expected = uv(obj, "Holomorphic 1")
    press()
    assert np.array_equal(uv(obj, "Holomorphic 1"), expected)


def test_what_is_set_of_the_balanced_map_is_followed():
    obj = limb()
    press(density=2.0)
    assert tilings(obj) == [None]
    press(main="SEAMLESS", density=2.0)
    assert tilings(obj) != [None]


def test_poles_are_followed_and_seamless_is_for_all():
    obj = limb()
    heights = np.array(limb_arrays()[0])[:, 2]
    pick(obj, [int(heights.argmin()), int(heights.argmax())])
    assert press() == {"FINISHED"}
    assert tilings(obj) == [None]
    assert press(main="SEAMLESS") == {"FINISHED"}
    assert tilings(obj) != [None]


def test_parts_of_both_kinds_lie_side_by_side_at_one_density():
    obj = two_parts("Both", limb_arrays(), grid_arrays())
    assert press() == {"FINISHED"}
    first, second = tilings(obj)
    assert first is not None and second is None
    values, count = uv(obj), 3 * len(limb_arrays()[1])
    assert values[:count, 0].max() < values[count:, 0].min() and values.min() > -1e-6
    is_first = (edge_sides(obj)[0] < len(limb_arrays()[0])).all(axis=1)
    _, whole, off = (each[is_first] for each in turned_jumps(obj, first["turns"]))
    assert off.max() == 0 and np.array_equal(whole, np.round(whole))
    densities = np.split(face_densities(obj), [len(limb_arrays()[1])])
    assert 0.5 < np.median(densities[0]) / np.median(densities[1]) < 2


def test_parts_share_the_density_of_the_largest():
    vertices, faces = limb_arrays()
    obj = two_parts("Two", (vertices, faces), (2 * np.asarray(vertices), faces))
    press()
    small, large = tilings(obj)
    assert small is not None and large is not None
    values = np.split(face_densities(obj), 2)
    assert 0.7 < np.median(values[0]) / np.median(values[1]) < 1.4


def test_a_checker_of_two_squares_in_each_tile_and_other_objects_keep_theirs():
    seamless, other = limb(), mesh_object("Grid", *grid_arrays())
    select(seamless, other)
    press(equal=False)
    assert shown_scale(seamless) == 2 and shown_scale(other) > 2
    press(equal=False, checker_scale=7)
    assert shown_scale(seamless) == 8 and shown_scale(other) == 7


def test_the_report_begins_with_words():
    obj = limb()
    press()
    lines = [line.strip() for line in obj.holomorph_map.made.summary.splitlines()]
    assert "seamless" in lines[2] and "quarter turns" in lines[2] and "cones" in lines[2]
    assert any(line.startswith("size range ") for line in lines)
    assert stored_report(obj)["dials"]["main"] == "AUTOMATIC"
    assert stored_report(obj)["components"][0]["forms"] == 1


def test_refused_parts_are_told_and_keep_their_map(monkeypatch):
    obj = torus()
    library = module("native").load()
    search = library.maps.map
    made = search.map_objects

    def refuse(objects, size, **options):
        if objects[0][0][0].main != "seamless":
            return made(objects, size, **options)
        return [search.MappedParts([library.TopologyError("too few tiles")], size)]

    monkeypatch.setattr(search, "map_objects", refuse)
    assert press(main="SEAMLESS") == {"FINISHED"}
    assert tilings(obj) == [None] and fills_the_square(uv(obj))
    outcome = written(obj, main="SEAMLESS")
    assert outcome.problems[-1] == "Torus: not seamless: too few tiles" and "seams in view" in outcome.problems[0]
    assert not any("not seamless" in told for told in written(obj).problems)


def test_the_redo_panel_makes_nothing_again(monkeypatch):
    """Scales do not turn: they have a map of their own, which is kept, too, and no solve."""
    limb()
    press()

    def forbidden(*_arguments, **_options):
        raise AssertionError("made again")

    monkeypatch.setattr(module("solving.jobs"), "solved_anew", forbidden)
    press(texture="SCALES")
    monkeypatch.setattr(module("native").load().maps.map, "map_objects", forbidden)
    for texture in ("CHECKER", "WEAVE", "SCALES"):
        assert press(seams=True, texture=texture) == {"FINISHED"}


def test_cancelling_in_a_tiling_leaves_no_result():
    obj = limb()
    targets, jobs = module("scene.targets"), module("solving.jobs")
    tasks = targets.tasks(targets.collect([obj])) * 2
    job = jobs.Job(tasks, lambda fraction: job.cancel() if fraction > 0.2 else None, then(2))
    job.start()
    job.wait()
    assert all(isinstance(found, module("native").load().Cancelled) for found in job.results)
    assert not module("solving.jobs").KEPT.get(tasks[0].key).maps


def test_progress_grows_over_solve_and_tiling():
    obj, seen = limb(), []
    targets = module("scene.targets")
    tasks = targets.tasks(targets.collect([obj]))
    module("solving.jobs").Job(tasks, seen.append, then()).run()
    assert seen == sorted(seen) and seen[0] >= 0 and 0.5 < seen[-1] <= 1


def test_the_same_bits_twice():
    obj = two_parts("Both", limb_arrays(), torus_arrays(thickness=0.1, bulge=0))
    press()
    before = uv(obj)
    module("solving.jobs").KEPT.clear()
    press()
    assert np.array_equal(uv(obj), before)


def test_undo_takes_everything_back():
    obj = limb()
    bpy.ops.ed.undo_push(message="before")
    before = everything(obj)["maps"]
    press(seams=True)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Limb"]
    assert everything(obj)["maps"] == before == {}
    assert "holomorph_report" not in obj and not obj.material_slots
    assert not mesh_io.read_seams(obj.data).any()


def test_seams_are_where_the_tiling_jumps():
    obj = limb()
    press(seams=True)
    ends = {frozenset(edge) for edge in mesh_io.marked_edges(obj.data, "use_seam").tolist()}
    vertices, jumps = edge_jumps(obj)
    is_torn = np.abs(jumps).max(axis=(1, 2)) > 1e-4
    assert is_torn.any() and {frozenset(edge) for edge in vertices[is_torn].tolist()} <= ends


def test_the_balanced_map_is_evened_and_those_of_the_forms_are_not():
    obj = limb()
    ranges, forms = [], []
    for evenness in (0, 0.5, 1):
        press(main="BALANCED", evenness=evenness)
        (part,) = stored_report(obj)["components"]
        assert part["main_map"]["evenness"] == evenness
        ranges.append(part["main_map"]["size_range"])
        forms.append(uv(obj, "Holomorphic 1"))
    assert ranges[1] < 0.95 * ranges[0] and ranges[2] < 0.95 * ranges[1]
    assert all(np.array_equal(forms[0], other) for other in forms[1:])
