"""What is chosen on a mesh (vertices, residues, seams), and how it reaches the library."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    grid_arrays,
    mesh_io,
    mesh_object,
    pick,
    sphere_arrays,
    torus,
    torus_arrays,
)

choices, native, targets = module("solving.choices"), module("native"), module("scene.targets")


def part_of(*arrays):
    (part,) = native.load().Surface(*arrays).components
    return part


def two_grids():
    """A surface of two parts with their vertices mixed: the even ones are the first grid's."""
    vertices, faces = grid_arrays()
    mixed = np.empty((2 * len(vertices), 3))
    mixed[::2], mixed[1::2] = vertices, vertices + (0, 0, 5)
    return native.load().Surface(mixed, np.concatenate([2 * faces, 2 * faces + 1]))


def test_numbers():
    assert choices.numbers("") == ()
    assert choices.numbers("1, 1 -2") == (1, 1, -2)
    assert choices.numbers("1+0.5j,-1-0.5j") == (1 + 0.5j, -1 - 0.5j)
    for wrong in ("one", "1 nan", "inf"):
        with pytest.raises(ValueError, match="is not a number"):
            choices.numbers(wrong)


def test_each_part_gets_its_own_vertices_and_residues():
    chosen = choices.Choices(choices.POLES, (17, 40, 6), residues=(1, 2, 3))
    first, second = two_grids().components
    if first.vertex_index[0] != 0:
        first, second = second, first
    (keywords,) = choices.attempts(first, chosen)
    assert keywords["poles"].tolist() == [40, 6]
    assert keywords["residues"].tolist() == [2, 3]
    (keywords,) = choices.attempts(second, chosen)
    assert keywords["poles"].tolist() == [17]


def test_what_was_only_found_is_left_out_in_the_end():
    part = part_of(*grid_arrays())
    seams = np.array([[16, 17], [17, 18]])
    found = choices.Choices(choices.AUTOMATIC, (24,), seams=seams, boundary="double_cover")
    wanted = choices.attempts(part, found)
    assert [("poles" in w, "cuts" in w) for w in wanted] == [(1, 1), (1, 0), (0, 1), (0, 0)]
    assert all(w["boundary"] == "natural" for w in wanted)  # a disk has no forms
    explicit = choices.Choices(choices.POLES, (24,), seams=seams)
    assert [("poles" in w, "cuts" in w) for w in choices.attempts(part, explicit)] == [(1, 1), (1, 0)]
    assert choices.attempts(part, choices.Choices(choices.NONE, (24,))) == [{"solver": "auto", "boundary": "natural"}]


def test_methods_are_taken_where_they_fit():
    vertices, faces = grid_arrays()
    ring, torus_part = part_of(vertices, np.delete(faces, 14, axis=0)), part_of(*torus_arrays())
    sphere = part_of(*sphere_arrays())
    chosen = choices.Choices(boundary="double_cover", solver="paper")
    found = [choices.attempts(part, chosen)[0] for part in (ring, torus_part, sphere)]
    assert [k["boundary"] for k in found] == ["double_cover", "natural", "natural"]
    assert [k["solver"] for k in found] == ["paper", "paper", "auto"]
    free, natural = choices.attempts(ring, choices.Choices(boundary=choices.ISLANDS, solver="paper"))
    assert (free["boundary"], free["solver"], natural["solver"]) == ("free", "auto", "paper")
    with_poles = choices.Choices(choices.POLES, (3, 150), solver="paper")
    assert choices.attempts(torus_part, with_poles)[0]["solver"] == "auto"


def test_four_boundary_vertices_of_a_disk_are_corners():
    part = part_of(*grid_arrays(6))
    found = choices.attempts(part, choices.Choices(choices.AUTOMATIC, (48, 6, 42, 0)))[0]
    assert found["corners"].tolist() == [48, 6, 42, 0] and "poles" not in found
    assert "poles" in choices.attempts(part, choices.Choices(choices.AUTOMATIC, (0, 24, 48, 6)))[0]


def test_choices_that_change_nothing_have_one_key():
    assert choices.Choices(choices.AUTOMATIC).key == choices.Choices(choices.NONE).key
    assert choices.Choices(choices.AUTOMATIC, (3,)).key != choices.Choices(choices.NONE).key
    assert choices.Choices(seams=np.array([[1, 2]])).key != choices.Choices().key


def collected(obj, use):
    (target,) = targets.collect([obj], choices.Choices(use=use))
    return target.chosen.vertices


def test_the_selection_is_read_in_its_order():
    obj = torus()
    pick(obj, [50, 7, 120])
    assert collected(obj, choices.AUTOMATIC) == (50, 7, 120)
    assert collected(obj, choices.POLES) == (50, 7, 120)
    assert collected(obj, choices.NONE) == ()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert collected(obj, choices.AUTOMATIC) == ()
    assert collected(obj, choices.POLES) == (7, 50, 120)


def test_selected_edges_and_everything_selected_are_no_choice():
    obj = torus()
    pick(obj, [0, 1, 50])
    assert collected(obj, choices.AUTOMATIC) == ()
    bpy.ops.mesh.select_all(action="SELECT")
    assert collected(obj, choices.AUTOMATIC) == ()
    assert len(collected(obj, choices.POLES)) == len(torus_arrays()[0])


def test_a_loose_vertex_cannot_be_chosen():
    vertices, faces = sphere_arrays()
    obj = mesh_object("Sphere", [*vertices, (3, 3, 3)], faces)
    (task,) = targets.tasks(targets.collect([obj], choices.Choices(choices.POLES, (0, 162))))
    with pytest.raises(native.load().InvalidMesh, match="vertex 162 belongs to no face"):
        module("solving.solve").solve(task)


def test_seams_are_read_as_vertices():
    obj = torus()
    obj.data.edges[4].use_seam = True
    (pair,) = mesh_io.marked_edges(obj.data, "use_seam")
    assert sorted(pair) == sorted(obj.data.edges[4].vertices)
