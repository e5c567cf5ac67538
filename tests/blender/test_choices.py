"""What is chosen on a mesh (vertices, residues, seams), and how it reaches the library."""

import bpy
import pytest
from loaded_addon import module
from scenes import mesh_io, mesh_object, pick, sphere_arrays, torus, torus_arrays

solve, native, targets = module("solving.jobs"), module("native"), module("scene.targets")


def test_residues():
    assert module("operators.request").residues("") == ()
    assert module("operators.request").residues("1, 1 -2") == (1, 1, -2)
    assert module("operators.request").residues("1+0.5j,-1-0.5j") == (1 + 0.5j, -1 - 0.5j)
    for wrong in ("one", "1 nan", "inf"):
        with pytest.raises(ValueError, match="is not a number"):
            module("operators.request").residues(wrong)


def collected(obj, use):
    (target,) = targets.collect([obj], solve.Choices(use=use))
    return target.chosen.vertices


def test_the_selection_is_read_in_its_order():
    obj = torus()
    pick(obj, [50, 7, 120])
    assert collected(obj, solve.AUTOMATIC) == (50, 7, 120)
    assert collected(obj, solve.POLES) == (50, 7, 120)
    assert collected(obj, solve.NONE) == ()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert collected(obj, solve.AUTOMATIC) == ()
    assert collected(obj, solve.POLES) == (7, 50, 120)


def test_selected_edges_and_everything_selected_are_no_choice():
    obj = torus()
    pick(obj, [0, 1, 50])
    assert collected(obj, solve.AUTOMATIC) == ()
    bpy.ops.mesh.select_all(action="SELECT")
    assert collected(obj, solve.AUTOMATIC) == ()
    assert len(collected(obj, solve.POLES)) == len(torus_arrays()[0])


def test_a_loose_vertex_cannot_be_chosen():
    vertices, faces = sphere_arrays()
    obj = mesh_object("Sphere", [*vertices, (3, 3, 3)], faces)
    (task,) = targets.tasks(targets.collect([obj], solve.Choices(solve.POLES, (0, 162))))
    with pytest.raises(native.load().InvalidMesh, match="vertex 162 belongs to no face"):
        solve.solve(task)


def test_seams_are_read_as_vertices():
    obj = torus()
    obj.data.edges[4].use_seam = True
    (pair,) = mesh_io.marked_edges(obj.data, "use_seam")
    assert sorted(pair) == sorted(obj.data.edges[4].vertices)
