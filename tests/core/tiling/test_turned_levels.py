"""Levels of detail of maps that turn: every vertex keeps its UVs, every edge its jump, up to turns."""

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, ProgressiveMesh, TopologyError, automatic_map
from holomorph.levels.levels import cones
from solved import surface_of

SHAPES = {"ball": families.geodesic_sphere(10), "torus": families.torus(40, 24), "bowl": families.hemisphere(10)}


@pytest.fixture(scope="module", params=[(name, turns) for name in SHAPES for turns in (2, 4)])
def made(request):
    name, turns = request.param
    return automatic_map(surface_of(SHAPES[name]), main="seamless", turns=turns)


def edge_jumps(surface, uv, turns):
    """(turn, translation, what is left over) across each inner edge."""
    at, edges = (uv @ [1, 1j])[surface.triangle_corners], surface._native.triangle_edges.ravel()
    start, end = at.ravel(), np.roll(at, -1, axis=1).ravel()
    order = np.argsort(edges, kind="stable")
    first = np.flatnonzero(edges[order][1:] == edges[order][:-1])
    one, other = order[first], order[first + 1]
    powers = np.array([1, 1j, -1, -1j])[:: 4 // turns, None]
    shift = end[other] - powers * start[one]
    off = np.abs(shift - (start[other] - powers * end[one]))
    best = np.argmin(off, axis=0)
    rows = np.arange(len(best))
    return best, shift[best, rows], off[best, rows]


@pytest.mark.parametrize("count", [600, 150, 0])
def test_all_jumps_stay_exact(made, count):
    mesh = ProgressiveMesh(made.surface, kept=made.cones)
    (level,) = mesh.levels_of_detail(made.uv, [count], turns=made.turns)
    _, shift, off = edge_jumps(level.surface, level.uv, made.turns)
    assert off.max() == 0 and np.array_equal(shift, np.round(shift))
    assert np.isin(made.cones, level.surface.vertex_index).all()
    assert level.surface.euler_characteristic == made.surface.euler_characteristic


def test_vertices_keep_their_uvs(made):
    """Up to turns and whole tiles."""
    mesh = ProgressiveMesh(made.surface, kept=made.cones)
    (level,) = mesh.levels_of_detail(made.uv, [300], turns=made.turns)
    vertices = level.surface.vertex_index[level.surface.corner_vertices]
    first = dict(zip(made.surface.corner_vertices.tolist(), (made.uv @ [1, 1j]).tolist()))
    own = np.array([first[v] for v in vertices.tolist()])
    jumps = [level.uv @ [1, 1j] - turn * own for turn in np.array([1, 1j, -1, -1j])[:: 4 // made.turns]]
    assert np.any([jump == np.round(jump) for jump in jumps], axis=0).all()


def test_cones_are_found_and_kept(made):
    assert np.array_equal(cones(made.surface, made.uv, made.turns), np.sort(made.cones))
    if made.surface.boundary_count == 0:
        with pytest.raises(TopologyError, match="a cone of a map that turns was collapsed: keep all of them"):
            ProgressiveMesh(made.surface).levels_of_detail(made.uv, [20], turns=made.turns)


def test_several_maps_at_once(made):
    """Each is what it is alone, whatever lies beside it."""
    mesh = ProgressiveMesh(made.surface, kept=made.cones)
    plain = made.surface.vertices[made.surface.corner_vertices, :2]
    both = np.stack([plain, made.uv], axis=1)
    (alone,) = mesh.levels_of_detail(made.uv, [200], turns=made.turns)
    (level,) = mesh.levels_of_detail(both, [200], turns=[1, made.turns])
    assert np.array_equal(level.uv[:, 1], alone.uv)
    assert np.allclose(level.uv[:, 0], level.surface.vertices[level.surface.corner_vertices, :2], atol=1e-12)


def test_wrong_options(made):
    with pytest.raises(ValueError, match="turns is 3; one of 1, 2, 4, 6 is needed"):
        ProgressiveMesh(made.surface).levels_of_detail(made.uv, [100], turns=3)
    with pytest.raises(InvalidMesh, match="kept names a vertex that is not in the surface"):
        ProgressiveMesh(made.surface, kept=[len(made.surface.vertices)])
