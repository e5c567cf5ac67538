"""Surfaces with isolated vertices, at any place: all functions ignore them, and name the surface's own vertices."""

import families
import numpy as np
import pytest
from holomorph import Surface, Tiler, automatic_map, automatic_maps, automatic_structure, form_map, log_map

MESHES = {
    "sphere": families.geodesic_sphere(4),
    "torus": families.torus(16, 9),
    "disk": families.hemisphere(5),
    "tube": families.cylinder(12, 8),
    "cube": families.cube(),
}


def with_isolated(mesh, where):
    """(surface, its vertex for each vertex of the mesh)"""
    count = len(mesh.vertices)
    at = {"first": [0, 0], "middle": [count // 3, count // 2], "end": [count, count], "none": []}[where]
    place = np.arange(count) + np.searchsorted(np.sort(at), np.arange(count), side="right")
    points = np.insert(mesh.vertices, at, 7.0, axis=0)
    assert np.array_equal(points[place], mesh.vertices)
    return Surface.from_polygons(points, place[mesh.corners], mesh.offsets), place


def places(value, place):
    return place[np.asarray(value)].tolist() if len(value) else []


def same_places(one, other, place):
    for name in ("poles", "seams", "cones"):
        assert places(getattr(one, name), place) == getattr(other, name).tolist(), name


def same_tiling(one, other, place):
    assert np.array_equal(one.uv, other.uv) and np.array_equal(one.periods, other.periods)
    same_places(one, other, place)
    assert places(one.zeros[0], place) == other.zeros[0].tolist()


@pytest.fixture(params=["first", "middle", "end"])
def where(request):
    return request.param


def both(name, where):
    """(the surface without, the one with isolated vertices, vertices of this one)"""
    return with_isolated(MESHES[name], "none")[0], *with_isolated(MESHES[name], where)


@pytest.mark.parametrize("name", MESHES)
def test_structures_and_their_maps(name, where):
    plain, surface, place = both(name, where)
    one, other = automatic_structure(plain), automatic_structure(surface)
    assert one.map_kind == other.map_kind and np.array_equal(place[one.edges], other.edges)
    maps = form_map(plain, one, evenness=0.5), form_map(surface, other, evenness=0.5)
    assert np.array_equal(maps[0].uv, maps[1].uv) and maps[0].kind == maps[1].kind
    same_places(*maps, place)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("main", ["automatic", "untiled", "balanced"])
def test_chosen_maps(name, main, where):
    plain, surface, place = both(name, where)
    one, other = automatic_map(plain, main=main), automatic_map(surface, main=main)
    (of_part,) = automatic_maps(surface, main=main)
    for made, own in ((other, place), (of_part, np.arange(len(place)))):
        assert made.kind == one.kind and np.array_equal(one.uv, made.uv)
        same_places(one, made, own)
        if one.tiling:
            same_tiling(one.tiling, made.tiling, own)


@pytest.mark.parametrize("turns", [1, 4])
@pytest.mark.parametrize("name", ["sphere", "torus", "tube"])
def test_tilings(name, turns, where):
    plain, surface, place = both(name, where)
    options = {"main": "seamless", "tiles": 30, "turns": turns}
    same_tiling(automatic_map(plain, **options).tiling, automatic_map(surface, **options).tiling, place)
    one, other = (automatic_structure(each).tile(30, turns=turns, evenness=0.5) for each in (plain, surface))
    same_tiling(one, other, place)


@pytest.mark.parametrize("name", ["sphere", "torus"])
def test_chosen_poles(name, where):
    plain, surface, place = both(name, where)
    poles = np.array([3, 40])
    one, other = Tiler(plain, poles.tolist()).tile(30), Tiler(surface, place[poles].tolist()).tile(30)
    same_tiling(one, other, place)
    assert other.poles.tolist() == place[poles].tolist()
    one, other = log_map(plain, poles), log_map(surface, place[poles])
    assert other.poles.tolist() == place[poles].tolist()
    assert np.array_equal(*(made.uv(made.balanced_coefficients()) for made in (one, other)))
