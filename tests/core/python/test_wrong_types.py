"""Arguments of a wrong type are refused in one sentence that names the argument and the type."""

import inspect

import families
import holomorph
import numpy as np
import pytest
from holomorph import InvalidMesh, ProgressiveMesh, Surface, conformal_structure, siegel_reduction
from solved import surface_of

OTHERS = ("mesh.obj", None, 3, np.zeros((3, 3)))


def functions_of_surfaces():
    """Names of public functions and classes that need a surface alone."""
    for name in dir(holomorph):
        value = getattr(holomorph, name)
        is_made_by_callers = inspect.isfunction(value) or value in (holomorph.Tiler, ProgressiveMesh)
        parameters = list(inspect.signature(value).parameters.values()) if is_made_by_callers else []
        needed = [each for each in parameters if each.default is each.empty and each.kind != each.VAR_KEYWORD]
        if parameters and parameters[0].annotation in (Surface, "Surface") and len(needed) == 1:
            yield name


@pytest.mark.parametrize("name", list(functions_of_surfaces()))
def test_what_is_no_surface(name):
    for other in OTHERS:
        with pytest.raises(TypeError, match=f"is of type {type(other).__name__}; a Surface is needed"):
            getattr(holomorph, name)(other)


def test_the_usual_ones_are_among_them():
    assert {"conformal_structure", "automatic_map", "log_map", "place_poles"} <= set(functions_of_surfaces())


def test_what_is_no_structure():
    surface = surface_of(families.torus(8, 6))
    for function in (holomorph.igusa_invariants, holomorph.conformal_image):
        with pytest.raises(TypeError, match="structure is of type Surface; a .*Structure is needed"):
            function(surface)
    with pytest.raises(TypeError, match="structure is of type Surface; a Structure is needed"):
        holomorph.cut_along(surface, [])


@pytest.mark.parametrize("count", [np.nan, "many", None])
def test_what_is_no_number_of_triangles(count):
    mesh = ProgressiveMesh(surface_of(families.torus(8, 6)))
    with pytest.raises(ValueError, match="n_faces is .*; a number of triangles is needed"):
        mesh.level(count)


def test_all_triangles_are_no_error():
    mesh = ProgressiveMesh(surface_of(families.torus(8, 6)))
    assert len(mesh.level(np.inf).triangles) == 96


@pytest.mark.parametrize("matrix", [0.3 + 0.1j, [1j, 2j], np.zeros((0, 0)), [[1j, 0], [1, 1j]]])
def test_what_is_no_period_matrix(matrix):
    with pytest.raises(ValueError, match="a period matrix is square, symmetric and finite"):
        siegel_reduction(matrix)


def test_memory_views_are_arrays():
    mesh = families.torus(8, 6, shape="triangles")
    faces = mesh.corners.reshape(-1, 3)
    views = memoryview(mesh.vertices), memoryview(np.ascontiguousarray(faces))
    assert np.array_equal(Surface(*views).triangles, Surface(mesh.vertices, faces).triangles)
    with pytest.raises(InvalidMesh, match="faces has the type float64; integers are needed"):
        Surface(mesh.vertices, memoryview(mesh.vertices))


def test_a_path_is_no_number():
    with pytest.raises(TypeError, match="not int"):
        Surface.read(3)


def test_a_rotation_is_a_number():
    surface = surface_of(families.torus(8, 6))
    structure = conformal_structure(surface)
    with pytest.raises(ValueError, match=r"rotation is \[1\]; a finite number is needed"):
        holomorph.frame(surface, structure.uv([1]), rotation=[1])
