"""What is chosen on a mesh becomes keywords of `automatic_structure` for each part; what is only found is left out."""

import numpy as np
import pytest
from families import cylinder, geodesic_sphere, torus
from holomorph import InvalidMesh, Surface, TopologyError
from holomorph.maps.chosen_structures import (
    AUTOMATIC,
    NONE,
    POLES,
    RECTANGLE,
    Choices,
    chosen_structures,
    wanted,
)
from plane_meshes import grid
from solved import surface_of

GRID = grid(6, 6)
SEAMS = np.array([[16, 17], [17, 18]])  # inside
TORUS = torus(16, 12)


def two_grids():
    """Polygons of two parts with their vertices mixed: the even ones are the first grid's."""
    mixed = np.repeat(GRID.vertices, 2, axis=0)
    mixed[1::2] += (0, 0, 5)
    corners = np.concatenate([2 * GRID.corners, 2 * GRID.corners + 1])
    return mixed, corners, np.concatenate([GRID.offsets, GRID.offsets[-1] + GRID.offsets[1:]])


def test_each_part_gets_its_own_vertices_and_residues():
    chosen = Choices(POLES, (17, 40, 6), residues=(1, 2, 3))
    first, second = sorted(Surface.from_polygons(*two_grids()).components, key=lambda part: part.vertex_index[0])
    (keywords,) = wanted(first, chosen)
    assert keywords["poles"].tolist() == [40, 6]
    assert keywords["residues"].tolist() == [2, 3]
    (keywords,) = wanted(second, chosen)
    assert keywords["poles"].tolist() == [17]


def test_what_was_only_found_is_left_out_in_the_end():
    part = surface_of(GRID)
    found = wanted(part, Choices(AUTOMATIC, (24,), seams=SEAMS))
    assert [("poles" in w, "cuts" in w) for w in found] == [(1, 1), (1, 0), (0, 1), (0, 0)]
    explicit = wanted(part, Choices(POLES, (24,), seams=SEAMS))
    assert [("poles" in w, "cuts" in w) for w in explicit] == [(1, 1), (1, 0)]
    assert wanted(part, Choices(NONE, (24,))) == [{"solver": "auto"}]


def test_the_solver_of_the_paper_is_for_parts_with_forms():
    ring, closed, sphere = (surface_of(mesh) for mesh in (cylinder(8, 3), TORUS, geodesic_sphere(3)))
    chosen = Choices(solver="paper")
    assert [wanted(part, chosen)[0]["solver"] for part in (ring, closed, sphere)] == ["paper", "paper", "auto"]
    assert wanted(closed, Choices(POLES, (3, 150), solver="paper"))[0]["solver"] == "auto"


def test_four_boundary_vertices_of_a_disk_are_corners():
    part = surface_of(GRID)
    found = wanted(part, Choices(AUTOMATIC, (48, 6, 42, 0)))[0]
    assert found["corners"].tolist() == [48, 6, 42, 0] and "poles" not in found
    assert "poles" in wanted(part, Choices(AUTOMATIC, (0, 24, 48, 6)))[0]


def test_choices_that_change_nothing_have_one_key():
    assert Choices(AUTOMATIC).key == Choices(NONE).key
    assert Choices(AUTOMATIC, (3,)).key != Choices(NONE).key
    assert Choices(seams=np.array([[1, 2]])).key != Choices().key


def test_a_choice_that_is_found_gives_way_and_an_explicit_one_refuses():
    """One pole alone, on a torus: its residue would have to be 0."""
    arrays = TORUS.vertices, TORUS.corners, TORUS.offsets
    _, (part,) = chosen_structures(*arrays, Choices(AUTOMATIC, (5,)))
    assert part.structure.form_count == 1 and part.note and not part.is_chosen
    with pytest.raises(TopologyError, match="pole 5 is the only one"):
        chosen_structures(*arrays, Choices(POLES, (5,)))
    with pytest.raises(InvalidMesh, match="vertex 999 belongs to no face"):
        chosen_structures(*arrays, Choices(POLES, (5, 999)))


def test_a_rectangle_is_of_one_part_and_the_other_is_solved_as_usual():
    surface, parts = chosen_structures(*two_grids(), Choices(RECTANGLE, (0, 12, 84, 96)))
    assert [part.is_chosen for part in parts] == [True, False]
    assert all(part.structure.surface is surface for part in parts)
