"""Maps of parts with so many loops that their forms would take longer than all else."""

import pickle

import costly
import families
import numpy as np
import pytest
from holomorph import Surface, automatic_map, automatic_maps, conformal_structure
from holomorph.maps import late_structure
from holomorph.maps.chosen_structures import POLES, Choices, chosen_structures
from holomorph.maps.report import part_report
from solved import surface_of

MANY = {"plate": (costly.plate, 6400), "latin": (costly.latin, 1200)}


def is_solved(structure):
    return "made" in vars(structure)


@pytest.fixture
def late(monkeypatch):
    """Any forms are too many."""
    monkeypatch.setattr(late_structure, "MOST_SECONDS", 0.0)
    monkeypatch.setattr(late_structure, "MOST_PER_TRIANGLE", 0.0)


@pytest.mark.parametrize("name", MANY)
def test_islands_are_taken_and_no_form_is_solved_for(name):
    make, size = MANY[name]
    found = automatic_map(Surface(*make(size)))
    assert found.islands
    assert "too many to solve for; it flattens" in found.why
    assert part_report(found)["description"] == found.structure.description
    assert not is_solved(found.structure)


@pytest.mark.parametrize("mesh", [families.torus(24, 18), families.block_with_holes(3), families.punctured_torus()])
def test_few_forms_are_solved_for(mesh):
    assert not isinstance(automatic_map(surface_of(mesh)).structure, late_structure.LateStructure)


@pytest.mark.parametrize("mesh", [families.block_with_holes(2, refine=2), families.punctured_torus(), families.cage()])
@pytest.mark.usefixtures("late")
def test_the_structure_is_there_when_it_is_asked_for(mesh):
    surface = surface_of(mesh)
    expected, found = conformal_structure(surface), automatic_map(surface, main="untiled")
    for structure in (found.structure, pickle.loads(pickle.dumps(found)).structure):
        assert not is_solved(structure)
        assert structure.period_matrix.tobytes() == expected.period_matrix.tobytes()
        assert structure.edges.tobytes() == expected.edges.tobytes()


@pytest.mark.usefixtures("late")
def test_what_needs_forms_gets_them():
    surface = surface_of(families.block_with_holes(2, refine=2))
    assert automatic_map(surface, main="seamless").tiling
    balanced = automatic_map(surface, main="balanced", evenness=0)
    structure = conformal_structure(surface)
    np.testing.assert_array_equal(balanced.uv, structure.uv(structure.balanced_coefficients()))


@pytest.mark.usefixtures("late")
def test_parts_of_a_mesh():
    """Vertices are those of the mesh; where poles are chosen the forms are solved for."""
    mesh = families.united(families.cube(), families.block_with_holes(2, refine=2))
    arrays = mesh.vertices, mesh.corners, mesh.offsets
    surface, parts = chosen_structures(*arrays)
    assert not is_solved(parts[1].structure)
    assert parts[1].structure.surface is surface
    assert parts[1].structure.edges.min() >= len(families.cube().vertices)
    made = automatic_maps([part.surface for part in parts], [part.structure for part in parts])
    assert made[1].islands and not is_solved(parts[1].structure)
    pole = int(parts[1].surface.vertex_index[0])
    _, chosen = chosen_structures(*arrays, Choices(POLES, (pole, pole + 5)))
    assert chosen[1].structure.poles.tolist() == [pole, pole + 5]
