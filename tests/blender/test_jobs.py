"""The worker thread, its cancelling, and what is kept."""

import threading
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import mesh_io, mesh_object, run, select, sphere_arrays, torus, torus_arrays, uv

native = module("native")
SECONDS = 60


def task_of(obj):
    return module("solving.jobs").Task(mesh_io.read_polygons(obj.data, np.eye(3)))


def test_a_worker_gives_what_the_main_thread_gives():
    tasks = [task_of(torus("First")), task_of(mesh_object("Second", *sphere_arrays()))]
    job = module("solving.jobs").Job(tasks)
    job.start()
    job.wait()
    assert not job.is_running()
    assert [r.form_count for r in job.results] == [1, 1]


def test_one_copy_of_the_arrays_is_left():
    task = task_of(torus())
    given = [a.copy() for a in (task.polygons.vertices, task.polygons.corner_vertices, task.polygons.face_offsets)]
    surface = module("solving.jobs").solve(task).surface
    left = (task.polygons.vertices, task.polygons.corner_vertices, task.polygons.face_offsets)
    for array, own, before in zip(left, (surface.vertices, surface.corner_vertices, surface.face_offsets), given):
        assert np.shares_memory(array, own) and array.dtype == before.dtype and (array == before).all()


def test_a_refused_mesh_is_a_result_and_the_next_is_solved():
    vertices, faces = torus_arrays()
    bad = mesh_object("Bad", vertices * np.nan, faces)
    job = module("solving.jobs").Job([task_of(bad), task_of(torus())])
    job.start()
    job.wait()
    assert isinstance(job.results[0], native.load().InvalidMesh)
    assert job.results[1].form_count == 1


def test_too_little_memory_is_a_sentence_and_the_next_is_solved(monkeypatch):
    sentence = "there is not enough memory for a mesh of this size"
    large, other = torus("Large", around=100), torus("Other")
    solve = module("solving.jobs")
    solve_any = solve.solve

    def solve_small(task, *rest):
        if task.key == tasks[0].key:
            raise MemoryError(sentence)
        return solve_any(task, *rest)

    tasks = [task_of(large), task_of(other)]
    monkeypatch.setattr(solve, "solve", solve_small)
    job = module("solving.jobs").Job(tasks)
    job.run()
    assert isinstance(job.results[0], MemoryError) and str(job.results[0]) == sentence
    assert job.results[1].form_count == 1
    layers = len(large.data.uv_layers)
    select(large)
    with pytest.raises(RuntimeError, match=f"Large: {sentence}"):
        run()
    assert len(large.data.uv_layers) == layers


def test_cancel_leaves_the_rest_undone():
    task = task_of(torus(around=200, across=100))
    job = None

    def cancel_at_once(_fraction):
        job.cancel()

    job = module("solving.jobs").Job([task, task], cancel_at_once)
    job.start()
    job.wait()
    assert isinstance(job.results[0], native.load().Cancelled) and job.results[1] is None
    assert module("solving.jobs").KEPT.get(task.key) is None


def test_the_cross_cancels_what_is_running(monkeypatch):
    """And nothing else can be pressed in our tab, but where a map follows its dials."""
    map_panel, mixins, follow = map(module, ("interface.map_panel", "operators.mixins", "operators.follow"))
    work = module("solving.jobs").Job([])
    assert not bpy.ops.uv.holomorphic_stop.poll() and not map_panel.is_blocked()
    monkeypatch.setattr(mixins.WorkOperator, "running", work)
    assert map_panel.is_blocked()
    assert bpy.ops.uv.holomorphic_stop() == {"FINISHED"} and work.watch.is_cancelled
    monkeypatch.setattr(follow.HOLOMORPH_OT_follow, "active", "Torus")
    assert not map_panel.is_blocked()


@pytest.mark.parametrize(("seconds", "words"), [(5.4, "5 s"), (34, "30 s"), (75, "1 min"), (4900, "80 min")])
def test_expected_times_are_round(seconds, words):
    assert module("interface.map_panel").in_words(seconds) == words


def test_progress_grows_from_0_to_1():
    seen = []
    tasks = [task_of(torus("First", around=100)), task_of(torus("Second", around=120))]
    job = module("solving.jobs").Job(tasks, lambda fraction: seen.append((fraction, job.watch.stage)))
    job.run()
    fractions = [f for f, _ in seen]
    assert fractions and fractions == sorted(fractions) and fractions[0] >= 0 and fractions[-1] <= 1
    assert all(isinstance(stage, str) for _, stage in seen)


def test_our_own_mistakes_come_out_of_the_thread(monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("our own mistake")

    monkeypatch.setattr(module("solving.jobs"), "solve", broken)
    job = module("solving.jobs").Job([task_of(torus())])
    job.start()
    with pytest.raises(ZeroDivisionError):
        job.wait()


def test_no_thread_is_left():
    job = module("solving.jobs").Job([task_of(torus(around=60))])
    job.start()
    own = [thread for thread in threading.enumerate() if thread.name.startswith("holomorph")]
    job.wait()
    for thread in own:
        thread.join(SECONDS)
    assert own and not any(thread.is_alive() for thread in own)


def test_the_oldest_solves_go_when_memory_is_full(monkeypatch):
    kept = module("solving.jobs").KEPT
    objects = [torus(str(size), around=size) for size in (20, 24, 28)]
    for obj in objects:
        module("solving.jobs").Job([task_of(obj)]).run()
    tasks = [task_of(obj) for obj in objects]
    assert all(kept.get(task.key) for task in tasks)
    monkeypatch.setattr(kept, "limit", 1)
    module("solving.jobs").Job([task_of(torus("Last", around=32))]).run()
    assert not any(kept.get(task.key) for task in tasks)
    assert kept.get(task_of(bpy.data.objects["Last"]).key)


def test_what_was_asked_for_longest_ago_goes_first_and_the_last_one_stays():
    kept, sizes = module("solving.jobs").Kept(10), {"a": 4, "b": 4, "c": 4, "large": 99}
    values = {name: SimpleNamespace(nbytes=size) for name, size in sizes.items()}
    for name in "ab":
        assert kept.keep(name, values[name]) is values[name]
    assert kept.get("a") is values["a"]
    kept.keep("c", values["c"])
    assert kept.get("b") is None and list(kept.values()) == [values["a"], values["c"]]
    kept.keep("large", values["large"])
    assert list(kept.values()) == [values["large"]]


def test_values_that_have_grown_are_dropped_when_they_are_counted_again():
    kept, first, second = module("solving.jobs").Kept(10), SimpleNamespace(nbytes=1), SimpleNamespace(nbytes=2)
    kept.keep(1, first), kept.keep(2, second)
    first.nbytes = 9
    assert list(kept.values()) == [first, second]
    kept.trim()
    assert list(kept.values()) == [second]


def test_any_difference_makes_another_task():
    task = task_of(torus())
    polygons = task.polygons
    assert task.key == task_of(torus("Again")).key
    moved, turned = polygons.vertices.copy(), polygons.corner_vertices.copy()
    moved[-1, 2] = np.nextafter(moved[-1, 2], 1)
    turned[:4] = np.roll(turned[:4], 1)
    solve = module("solving.jobs")
    changes = (
        {"vertices": moved},
        {"vertices": polygons.vertices[:-1]},
        {"corner_vertices": turned},
        {"face_offsets": np.delete(polygons.face_offsets, 1)},
    )
    for change in changes:
        assert task.key != solve.Task(replace(polygons, **change)).key
    other = module("solving.jobs").Choices(seams=np.array([[0, 1]]))
    assert task.key != replace(task, chosen=other).key
    assert task.key == solve.Task(replace(polygons, loops=np.arange(len(turned)))).key


def test_opening_a_file_forgets_the_solves():
    obj = torus()
    run()
    targets = module("scene.targets")
    (task,) = targets.tasks(targets.collect([obj]))
    assert module("solving.jobs").KEPT.get(task.key)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert module("solving.jobs").KEPT.get(task.key) is None


@pytest.mark.skipif(bpy.app.version >= (4, 0, 0), reason="since 4.0 corners are always in the polygons' order")
def test_corners_in_another_order_than_the_polygons():
    vertices, faces = torus_arrays()
    plain = torus("Plain")
    order = np.random.default_rng(3).permutation(len(faces))
    mesh = bpy.data.meshes.new("Shuffled")
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(faces.size)
    corners = np.empty_like(faces)
    corners[order] = faces  # polygon i has its corners at 4 order[i]
    mesh.loops.foreach_set("vertex_index", corners.astype(np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", (4 * order).astype(np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(faces), 4, np.int32))
    mesh.update(calc_edges=True)
    obj = bpy.data.objects.new("Shuffled", mesh)
    bpy.context.scene.collection.objects.link(obj)
    select(plain, obj)
    run()
    expected = uv(plain).reshape(-1, 4, 2)
    assert np.array_equal(uv(obj).reshape(-1, 4, 2)[order], expected)
