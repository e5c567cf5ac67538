"""Maps of parts with so many loops that their forms would take longer than all else."""

import pickle

import costly
import families
import numpy as np
import pytest
from holomorph import Surface, automatic_map, automatic_maps, conformal_structure
from holomorph.maps.automatic_structure import LateStructure, late_structure
from holomorph.maps.chosen_structures import Choices, chosen_structures
from holomorph.maps.report import part_report
from solved import surface_of

MANY = {"plate": (costly.plate, 6400), "latin": (costly.latin, 1200)}
FORMS = {"plate": (costly.plate, 4800), "latin": (costly.latin, 1200)}  # that can be solved for in seconds


def surface_with(shapes, name):
    make, size = shapes[name]
    return Surface(*make(size))


def is_solved(structure):
    return "made" in vars(structure)


@pytest.mark.parametrize("name", MANY)
def test_islands_are_taken_and_no_form_is_solved_for(name):
    found = automatic_map(surface_with(MANY, name))
    assert found.islands
    assert "too many to solve for; it flattens" in found.why
    assert part_report(found)["description"] == found.structure.description
    assert not is_solved(found.structure)


@pytest.mark.parametrize("mesh", [families.torus(24, 18), families.block_with_holes(3), families.punctured_torus()])
def test_few_forms_are_solved_for(mesh):
    assert not isinstance(automatic_map(surface_of(mesh)).structure, LateStructure)


@pytest.mark.parametrize("name", FORMS)
def test_the_structure_is_there_when_it_is_asked_for(name):
    surface = surface_with(FORMS, name)
    expected, found = conformal_structure(surface), automatic_map(surface, main="untiled")
    for structure in (found.structure, pickle.loads(pickle.dumps(found)).structure):
        assert not is_solved(structure)
        assert structure.period_matrix.tobytes() == expected.period_matrix.tobytes()
        assert structure.edges.tobytes() == expected.edges.tobytes()


def test_what_needs_forms_gets_them():
    surface = surface_with(FORMS, "plate")
    structure = conformal_structure(surface)
    balanced = automatic_map(surface, main="balanced", evenness=0)
    assert balanced.structure.period_matrix.tobytes() == structure.period_matrix.tobytes()
    assert balanced.kind == "forms"
    late = late_structure(surface)
    again = automatic_map(surface, late, main="balanced", evenness=0)
    assert again.structure is late.made  # the next map does not solve for it again


def test_parts_of_a_mesh():
    """Vertices are those of the mesh; where a solver is chosen the forms are solved for."""
    cube, (points, faces) = families.cube(), costly.plate(FORMS["plate"][1])
    plate = families.Mesh(points + 5, np.concatenate(faces), 4 * np.arange(len(faces) + 1))
    mesh = families.united(cube, plate)
    arrays = mesh.vertices, mesh.corners, mesh.offsets
    surface, parts = chosen_structures(*arrays)
    assert not is_solved(parts[1].structure)
    assert parts[1].structure.surface is surface
    assert parts[1].structure.edges.min() >= len(cube.vertices)
    made = automatic_maps([part.surface for part in parts], [part.structure for part in parts])
    assert made[1].islands and not is_solved(parts[1].structure)
    _, chosen = chosen_structures(*arrays, Choices(solver="direct"))
    assert chosen[1].structure.solver.name.startswith("direct")
