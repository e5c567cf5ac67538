"""What is chosen of a part reaches the function that makes its structure, with the vertices of the part."""

import holomorph
import numpy as np
import pytest
from families import cylinder, geodesic_sphere, hemisphere, torus, united
from holomorph import InvalidMesh, TopologyError, automatic_maps, automatic_structure, conformal_image
from holomorph.mesh.edges import around_boundary, boundary_edges
from plane_meshes import corners_of, grid, wavy
from solved import surface_of

SHEET = surface_of(grid(7, 5, wavy))
CORNERS = corners_of(7, 5)
RING = [[0, 6], [6, 12]]  # edges of the grid, inside


def same(made, expected):
    """Bit for bit, in kind and in UVs."""
    assert type(made) is type(expected) and made.description == expected.description
    assert np.array_equal(*(one.uv(one.balanced_coefficients()) for one in (made, expected)))


@pytest.mark.parametrize("start", range(4))
@pytest.mark.parametrize("order", [(0, 2, 1, 3), (0, 3, 2, 1), (0, 1, 2, 3)])
def test_corners_in_any_order(start, order):
    """They are taken as the boundary passes them, from the first on."""
    picked = np.roll(CORNERS, -start)[list(order)]
    assert around_boundary(SHEET, picked).tolist() == np.roll(CORNERS, -start).tolist()
    same(automatic_structure(SHEET, corners=picked), holomorph.rectangle_map(SHEET, np.roll(CORNERS, -start)))


def test_vertices_that_are_on_no_one_loop_stay_as_they_are():
    inside = np.array([CORNERS[0], 14, *CORNERS[2:]])
    assert around_boundary(SHEET, inside).tolist() == inside.tolist()
    tube = surface_of(cylinder(6, 3))
    loops = np.unique(boundary_edges(tube))
    apart = np.array([loops[0], loops[-1], loops[1], loops[-2]])
    assert around_boundary(tube, apart).tolist() == apart.tolist()
    with pytest.raises(TopologyError):
        automatic_structure(SHEET, corners=inside)
    for wrong in ([0.5, 1, 2, 3], [[0, 1], [2, 3]]):
        with pytest.raises(InvalidMesh, match="corners"):
            automatic_structure(SHEET, corners=wrong)


def test_the_first_choice_counts():
    disk, sphere = surface_of(hemisphere(5)), surface_of(geodesic_sphere(4))
    same(automatic_structure(disk, poles=[0], boundary="free"), holomorph.disk_map(disk, 0))
    same(automatic_structure(disk, poles=[0], residues=[1j]), holomorph.log_map(disk, [0], [1j]))
    same(automatic_structure(sphere, poles=[3, 40]), holomorph.log_map(sphere, [3, 40]))
    same(automatic_structure(SHEET, corners=CORNERS, poles=[14]), holomorph.rectangle_map(SHEET, CORNERS))
    same(automatic_structure(disk, boundary="free"), holomorph.free_boundary_map(disk))
    tube = surface_of(cylinder(8, 5))
    same(
        automatic_structure(tube, boundary="double_cover"),
        holomorph.conformal_structure(tube, boundary="double_cover"),
    )


def test_thresholds():
    tube = surface_of(cylinder(24, 20))
    chosen = {"solver": "paper", "thresholds": [200]}
    assert len(automatic_structure(tube, **chosen).solver.levels) == 3
    with pytest.raises(ValueError, match="thresholds need solver='paper'"):
        automatic_structure(SHEET, thresholds=[200])


def test_empty_choices_are_none():
    for surface in (SHEET, surface_of(torus(10, 6))):
        chosen = automatic_structure(surface, poles=[], corners=[], cuts=np.empty((0, 2), int))
        same(chosen, automatic_structure(surface))


def test_cuts():
    surface = surface_of(torus(10, 6))
    structure = holomorph.conformal_structure(surface)
    cuts = structure.edges[structure.seams]
    same(automatic_structure(surface, cuts=cuts), holomorph.cut_along(structure, cuts))
    with pytest.raises(TopologyError):
        automatic_structure(surface, cuts=[[0, 25]])


def test_images_on_the_sphere_and_in_the_disk():
    disk, sphere = surface_of(hemisphere(5)), surface_of(geodesic_sphere(4))
    on_sphere = conformal_image(automatic_structure(sphere))
    assert np.abs(np.linalg.norm(on_sphere, axis=1) - 1).max() < 1e-12
    in_disk = conformal_image(holomorph.disk_map(disk))
    radii = np.linalg.norm(in_disk[:, :2], axis=1)
    assert not in_disk[:, 2].any() and np.abs(radii[np.unique(boundary_edges(disk))] - 1).max() < 1e-9
    assert radii.max() < 1 + 1e-9
    for structure in (automatic_structure(surface_of(torus(8, 6))), holomorph.log_map(sphere, [0, 30, 60])):
        assert conformal_image(structure) is None


# ---- parts of a mesh ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def pair():
    """A large torus and a small one, which comes second."""
    return surface_of(united(torus(16, 10, R=3.0), torus(16, 10)))


def test_poles_and_places_are_named_by_the_mesh(pair):
    """Parts without poles get automatic ones, parts without allowed vertices none."""
    first, second = pair.components
    count = len(first.vertices)
    made = automatic_maps(pair, main="seamless", tiles=80, poles=[count + 5, count + 90])
    assert second.vertex_index[made[1].poles].tolist() == [count + 5, count + 90]
    allowed = np.zeros(len(pair.vertices), bool)
    allowed[: count // 2] = True
    made = automatic_maps(pair, main="seamless", tiles=80, poles=3, allowed=allowed)
    assert len(made[0].poles) and made[0].poles.max() < count // 2 and not len(made[1].poles)
    with pytest.raises(ValueError, match="allowed has the shape"):
        automatic_maps(pair, main="seamless", allowed=allowed[:-1])


def test_poles_that_are_moved(pair):
    """The rounding is kept, and only the pole of its part moves."""
    count = len(pair.components[0].vertices)
    structures = [automatic_structure(part) for part in pair.components]
    ask = {"structures": structures, "main": "seamless", "tiles": 80, "poles": 2}
    before = automatic_maps(pair, **ask)
    free = next(v for v in range(40, count) if v not in before[1].poles)
    moved = automatic_maps(pair, moves=[(1, count + free)], **ask)
    assert np.array_equal(moved[0].uv, before[0].uv)
    assert moved[1].poles[1] == free and np.array_equal(moved[1].tiling.residues, before[1].tiling.residues)


@pytest.mark.parametrize("evenness", [0.2, 0.8])
def test_the_last_rounding_is_evened_anew(evenness):
    """With the bits of a tiling that is made at once."""
    surface = surface_of(torus(16, 10))
    kept, fresh = (automatic_structure(surface) for _ in range(2))
    for first in (1.0, 0.5, evenness):
        found = kept.tile(60, poles=2, evenness=first)
    expected = fresh.tile(60, poles=2, evenness=evenness)
    assert np.array_equal(found.uv, expected.uv) and found.evenness == evenness
