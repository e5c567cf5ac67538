"""How far maps turn a texture from upright: on planes, walls and nets, whose angles are known."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Surface, _native, automatic_map, automatic_structure, island_map
from holomorph.maps.map import Map
from holomorph.quality.appearance import ON_ITS_HEAD, SIDEWAYS, of_direction
from holomorph.quality.quality import Direction, Quality
from plane_meshes import grid
from solved import surface_of


def wall(lean=0.0):
    """(A plane that leans back by so many degrees, its flat map with v upwards)"""
    mesh = grid(5, 4)
    flat, lean = mesh.vertices[:, :2], np.radians(lean)
    stood = np.column_stack([flat[:, 0], np.sin(lean) * flat[:, 1], np.cos(lean) * flat[:, 1]])
    surface = surface_of(replace(mesh, vertices=stood))
    return surface, flat[surface.corner_vertices]


def turned(uv, degrees):
    z = (uv @ [1, 1j]) * np.exp(1j * np.radians(degrees))
    return np.stack([z.real, z.imag], axis=1)


@pytest.mark.parametrize("lean", [0, 40, 65])
@pytest.mark.parametrize("degrees", [0, 10, 30, 90, 120, 170, 180])
def test_the_angle_is_that_by_which_the_map_is_turned(lean, degrees):
    surface, uv = wall(lean)
    found = Direction.of(surface._native, 3 * turned(uv, degrees), "Z")
    np.testing.assert_allclose(found.angle, degrees, atol=1e-5)
    assert found.steep_part == pytest.approx(1)
    parts = found.upright_part, found.sideways_part, found.upside_down_part
    assert parts == (degrees < 15, abs(degrees - 90) <= 20, degrees >= 160)


@pytest.mark.parametrize(("turns", "angles"), [(2, (30, 90, 60)), (4, (30, 0, 30)), (6, (30, 30, 0))])
def test_a_texture_that_turns_is_as_far_from_upright_as_its_nearest_turn(turns, angles):
    surface, uv = wall()
    for degrees, angle in zip((30, 90, 120), angles):
        found = Direction.of(surface._native, turned(uv, degrees), "Z", turns)
        np.testing.assert_allclose(found.angle, angle, atol=1e-5)


def test_nothing_is_up_on_a_floor():
    surface, uv = wall(75)
    found = Direction.of(surface._native, turned(uv, 90), "Z")
    assert (found.steep_part, found.upright_part, found.words) == (0, 1, "")
    assert Direction.of(surface._native, turned(uv, 90), "Y").steep_part == pytest.approx(1)


def test_the_cost_is_of_the_whole_area():
    surface, uv = wall()
    for degrees, wanted in ((0, 0), (90, SIDEWAYS), (180, ON_ITS_HEAD), (30, SIDEWAYS / 2)):
        at = turned(uv, degrees)
        made = Quality.of(surface._native, at, 1).upright(at, "Z")
        assert of_direction(made) == pytest.approx(wanted, abs=1e-9)
        floor, flat = wall(75)
        beside = Quality.of(floor._native, flat, 1).upright(flat, "Z")
        both = Quality.joined([made, beside], [1, 1])
        assert of_direction(both) == pytest.approx(wanted * surface.area / (surface.area + floor.area), abs=1e-9)
    assert of_direction(Quality.of(surface._native, uv, 1)) == 0


def test_what_is_wrong_is_said_in_words():
    surface, uv = wall()
    found = Direction.of(surface._native, turned(uv, 90), "Z")
    assert found.words == "almost all is sideways"
    part = np.cumsum(found.steep) < 0.21 * found.steep.sum()
    assert replace(found, angle=np.where(part, 175.0, 5.0)).words == "a fifth is upside down"
    assert replace(found, angle=np.where(part, 30.0, 5.0)).words == ""
    assert replace(found, angle=np.where(part, 5.0, 26.0)).words == "three quarters is slanted"
    assert replace(found, angle=np.where(part, 5.0, 24.0)).words == ""


def test_a_box_stands_upright_whatever_its_map():
    """In islands, and in tilings that turn by quarters: each polygon is turned by itself."""
    box = surface_of(families.voxel_surface(np.ones((4, 3, 5), bool), ((0, 0),)))
    for made in (automatic_map(box, main="untiled"), automatic_map(box, main="seamless", turns=4)):
        assert Direction.of(box._native, made.uv, "Z").upright_part > 0.99


def test_islands_are_joined_only_where_they_stay_upright():
    for count in (3, 4, 5):  # sides of more of them meet at less than 60 degrees
        made = island_map(pyramid(count))
        assert made.quality.direction.upright_part == pytest.approx(1)
        assert len(made.seams) > 0


def pyramid(count):
    angle = 2 * np.pi * np.arange(count) / count
    base = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    sides = [[k, (k + 1) % count, count] for k in range(count)]
    return Surface(np.vstack([base, [[0, 0, 1.5]]]), [*sides, list(range(count))[::-1]])


def test_the_balanced_map_is_turned_upright():
    """One factor of length 1 turns all of it."""
    surface, _ = wall()
    lying = Surface(surface.vertices[:, [2, 1, 0]], surface.corner_vertices.reshape(-1, 4))
    ring = surface_of(families.torus(24, 12))
    for each in (surface, lying, ring):
        structure = automatic_structure(each)
        asked = {"evenness": 0.0, "is_upright": True, "why": "", "threads": 0, "progress": None}
        made = Map.of_core(_native.form_map(structure._core, **asked), each, structure)
        np.testing.assert_allclose(np.abs(made.coefficients), np.abs(structure.balanced_coefficients()))
        assert each is ring or made.quality.direction.upright_part > 0.99
        assert of_direction(made.quality) < 0.6  # where it is 0.7 in the mean over all turns
