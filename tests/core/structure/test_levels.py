"""Levels of detail: UV maps that stay in place, with the same periods at every level."""

from functools import cache

import families
import numpy as np
import pytest
from forms import EdgeForms
from holomorph import Cancelled, InvalidMesh, ProgressiveMesh, Surface, TopologyError, conformal_structure
from repository import SHARED
from solved import CLOSED, solved, surface_of

REAL = ("kitten_19k.obj", "double-torus.obj", "fertility_ngon_g4.obj")
SOLVER = 1e-8  # what a relative residual of 1e-10 leaves of a UV map whose extent is about 1
EXACT = 1e-11  # rounding of UVs of integer periods, whose extent is below 100


@cache
def structure_of(name):
    """The structure of a family, or of a real mesh in its own polygons."""
    if name in CLOSED:
        return solved(name)
    if not (SHARED / "meshes" / name).is_file():
        pytest.skip(f"no ../shared/meshes/{name}")
    return conformal_structure(Surface.read(SHARED / "meshes" / name))


@cache
def progressive(name, order="quadric"):
    return ProgressiveMesh(structure_of(name).surface, order=order)


@cache
def integer_map(name):
    """(#C, 2) UVs that jump by integers across the seams; u and v have different periods over every loop."""
    structure = structure_of(name)
    count = len(structure.homology_basis)
    return structure.uv_of(np.arange(1, count + 1), np.arange(count) ** 2 % 7 - 3)


def counts(mesh):
    """Numbers of triangles, a fourth each, from the finest level to the base."""
    finest, base = len(mesh.level(2**31).triangles), len(mesh.base.triangles)
    return [finest // 4**k for k in range(12) if finest // 4**k > base] + [base]


def vectors(level):
    """(#T, 3, 2) of the sides of all triangles in UV space, (#T, 3) where they start and where they end."""
    at_corners, vertices = level.uv.reshape(-1, 3, 2), level.surface.triangles
    return np.roll(at_corners, -1, axis=1) - at_corners, vertices, np.roll(vertices, -1, axis=1)


def edge_values(level):
    """`EdgeForms` and (2, #E): du and dv on edges."""
    edges = EdgeForms(level.surface._native.edges, len(level.surface.vertices))
    vector, start, end = vectors(level)
    edge, sign = edges.index(start, end)
    values = np.zeros((2, len(edges.edges)))
    values[:, edge.ravel()] = (sign[:, :, None] * vector).reshape(-1, 2).T
    return edges, values


def largest_disagreement(level):
    """Between the vectors that the two triangles of an edge give it."""
    edges, values = edge_values(level)
    vector, start, end = vectors(level)
    return np.abs(edges.along(values, start, end).transpose(1, 2, 0) - vector).max()


def angle_energy(level):
    """Conformal energy above its least value, half the sum of k (du^2 + dv^2) less the signed area."""
    p = level.surface.vertices[level.surface.triangles]
    q = level.uv.reshape(-1, 3, 2)
    energy = 0.0
    for i in range(3):
        a, b = p[:, i - 2] - p[:, i], p[:, i - 1] - p[:, i]
        cot = (a * b).sum(1) / np.linalg.norm(np.cross(a, b), axis=1)
        energy += 0.25 * (cot * ((q[:, i - 2] - q[:, i - 1]) ** 2).sum(1)).sum()
    return energy


every_mesh = pytest.mark.parametrize("name", [*CLOSED, *REAL])


# ---- exact -----------------------------------------------------------------------------------------------------------


@every_mesh
@pytest.mark.parametrize("order", ["quadric", "independent"])
def test_every_vertex_keeps_its_uvs(name, order):
    """Bit for bit where the corner has a corner of the original at the same vertex, and up to a period elsewhere."""
    mesh, uv, surface = progressive(name, order), integer_map(name), structure_of(name).surface
    of_vertex = np.zeros((len(surface.vertices), 2))
    of_vertex[surface.corner_vertices] = uv
    for level in mesh.levels_of_detail(uv, counts(mesh)):
        vertex = level.surface.vertex_index[level.surface.corner_vertices]
        own = surface.corner_vertices[level.corners] == vertex
        assert (level.uv[own] == uv[level.corners[own]]).all()
        moved = level.uv - of_vertex[vertex]
        assert np.abs(moved - np.rint(moved)).max() < EXACT
        assert not level.drift.any()
        assert (level.vertex_map == mesh.vertex_map(len(level.surface.triangles))).all()


@every_mesh
def test_levels_have_equal_integer_periods(name):
    """Over the base's loops, lifted to each level; the map is continued by translations everywhere."""
    mesh = progressive(name)
    loops = conformal_structure(mesh.base).homology_basis
    expected = None
    for n, level in zip(counts(mesh), mesh.levels_of_detail(integer_map(name), counts(mesh))):
        assert largest_disagreement(level) < EXACT
        edges, values = edge_values(level)
        periods = edges.integrals(values, mesh.lift_loops(loops, n))
        assert np.abs(periods - np.rint(periods)).max() < EXACT
        expected = np.rint(periods) if expected is None else expected
        assert (np.rint(periods) == expected).all()
    assert expected.any(axis=1).all()


@every_mesh
def test_seams_of_levels_are_the_images_of_the_seams(name):
    mesh, structure = progressive(name), structure_of(name)
    seams = structure.edges[structure.seams]
    for n, level in zip(counts(mesh), mesh.levels_of_detail(integer_map(name), counts(mesh))):
        vertex_count = len(level.surface.vertices)
        images = np.sort(mesh.vertex_map(n)[seams], axis=1) @ [vertex_count, 1]
        start = level.surface.triangles
        end = np.roll(start, -1, axis=1)
        key = (np.minimum(start, end) * vertex_count + np.maximum(start, end)).ravel()
        at_start = level.uv.reshape(-1, 3, 2)
        at_low = np.where((start < end)[:, :, None], at_start, np.roll(at_start, -1, axis=1))
        order = np.argsort(key, kind="stable")
        low = at_low.reshape(-1, 2)[order]
        jumps = np.abs(low[0::2] - low[1::2]).max(axis=1) > EXACT
        assert np.isin(key[order][::2][jumps], images).all()


def test_several_maps_at_once_are_those_one_by_one():
    mesh, structure = progressive("genus 2 block"), structure_of("genus 2 block")
    maps = np.stack([structure.uv([1, 0]), structure.uv([0, 1j]), structure.uv([2, 1])], axis=1)
    for together, *alone in zip(*(mesh.levels_of_detail(uv, [300, 80]) for uv in (maps, *maps.transpose(1, 0, 2)))):
        assert together.uv.shape == (len(together.corners), 3, 2)
        assert together.drift.shape == (len(together.surface.vertices), 3)
        for index, level in enumerate(alone):
            assert np.abs(together.uv[:, index] - level.uv).max() < EXACT


@pytest.mark.parametrize("name", ["cube", "cylinder", "punctured torus", "two components"])
def test_a_map_without_seams_stays_a_function_of_the_vertices(name):
    """On any topology: the positions, say."""
    mesh = {
        "cube": families.cube(),
        "cylinder": families.cylinder(24, 12),
        "punctured torus": families.punctured_torus(),
        "two components": families.united(families.torus(10, 8, shape="triangles"), families.cube()),
    }[name]
    surface = surface_of(mesh)
    uv = surface.vertices[surface.corner_vertices][:, :2]
    progressive = ProgressiveMesh(surface)
    for level in progressive.levels_of_detail(uv, counts(progressive)):
        assert (level.uv == level.surface.vertices[level.surface.corner_vertices][:, :2]).all()


OPEN = {
    "genus 0, 2 loops": families.cylinder(24, 12),
    "genus 1, 1 loop": families.punctured_torus(),
    "genus 1, 3 loops": families.punched(families.torus(20, 15), 3),
}


@pytest.mark.parametrize("mesh", OPEN.values(), ids=OPEN.keys())
def test_straight_boundaries_stay_straight(mesh):
    """v is one number along each side of a boundary loop in the original, and so in every level."""
    structure = conformal_structure(surface_of(mesh))
    progressive = ProgressiveMesh(structure.surface)
    uv = structure.uv(structure.balanced_coefficients())
    for level in progressive.levels_of_detail(uv, counts(progressive)):
        edges, values = edge_values(level)
        assert largest_disagreement(level) < EXACT
        _, start, end = vectors(level)
        edge, _ = edges.index(start, end)
        at_boundary = np.bincount(edge.ravel(), minlength=len(edges.edges)) == 1
        assert at_boundary.any()
        assert np.abs(values[1, at_boundary]).max() < EXACT


def test_islands_of_other_maps_stay_where_they_are():
    """A cylinder unrolled with one rotated seam: collapses along the rim and inside keep each vertex's own UVs."""
    surface = surface_of(families.cylinder(24, 12))
    x, y, z = surface.vertices.T
    turn = np.arctan2(y, x)[surface.corner_vertices].reshape(len(surface.face_offsets) - 1, -1)
    turn = turn + 2 * np.pi * (turn < turn.max(axis=1, keepdims=True) - np.pi)
    uv = np.stack([turn.ravel(), z[surface.corner_vertices]], axis=1)
    uv[:, 1] += 0.01 * uv[:, 0] ** 2  # no translation across the seam any more
    mesh = ProgressiveMesh(surface, corner_data=uv)
    for level in mesh.levels_of_detail(uv, [200, 60]):
        own = surface.corner_vertices[level.corners] == level.surface.vertex_index[level.surface.corner_vertices]
        assert own.mean() > 0.75
        assert (level.uv[own] == uv[level.corners[own]]).all()


def test_corner_data_of_levels_are_rows_of_the_original():
    """Bit for bit, of any type; on the right side of every edge across which they jump."""
    surface = structure_of("genus 2 block").surface
    part = surface.vertices[:, 0] < np.median(surface.vertices[:, 0])
    data = np.stack([part[surface.corner_vertices], ~part[surface.corner_vertices]], axis=1)
    mesh = ProgressiveMesh(surface, corner_data=data)
    for n in counts(mesh):
        level = mesh.level(n)
        found = mesh.level_corner_data(n)
        assert found.dtype == bool
        assert (found[:, 0] == part[level.vertex_index[level.corner_vertices]]).all()
        assert (found[:, 0] != found[:, 1]).all()
    assert progressive("genus 2 block").level_corner_data(100) is None


# ---- harmonic maps of the levels -------------------------------------------------------------------------------------


@every_mesh
def test_harmonic_levels_are_the_forms_of_the_level(name):
    """Computed from the collapsed map, or from classes pulled back from the base: the same closed form on edges."""
    mesh, uv = progressive(name), integer_map(name)
    n = counts(mesh)[min(2, len(counts(mesh)) - 2)]
    (level,) = mesh.levels_of_detail(uv, [n], harmonic=True)
    structure = mesh.conformal_structure(n)
    edges, values = edge_values(level)
    periods = edges.integrals(values, structure.homology_basis)
    assert largest_disagreement(level) < EXACT
    assert np.abs(periods - np.rint(periods)).max() < EXACT
    assert np.abs(values - np.rint(periods) @ structure.harmonic_forms).max() < SOLVER * np.abs(uv).max()


@every_mesh
def test_harmonic_levels_have_the_least_energy_and_the_finest_one_is_the_original(name):
    mesh, uv = progressive(name), integer_map(name)
    collapsed, harmonic = (mesh.levels_of_detail(uv, counts(mesh), harmonic=h) for h in (False, True))
    for before, after in zip(collapsed, harmonic):
        if len(before.surface.repairs.zero_area_faces) == 0:
            assert angle_energy(after) <= angle_energy(before) * (1 + 1e-12)
        assert np.allclose(np.linalg.norm(after.uv - before.uv, axis=1), after.drift[after.surface.corner_vertices])
    assert harmonic[0].solver.residual < 1e-10


@pytest.mark.parametrize("mesh", OPEN.values(), ids=OPEN.keys())
def test_harmonic_levels_with_a_boundary(mesh):
    """The finest level is the map of the original; all keep v along the boundary, and gain energy."""
    structure = conformal_structure(surface_of(mesh))
    progressive = ProgressiveMesh(structure.surface)
    uv = structure.uv(structure.balanced_coefficients())
    collapsed, harmonic = (progressive.levels_of_detail(uv, counts(progressive), harmonic=h) for h in (False, True))
    for before, after in zip(collapsed, harmonic):
        assert largest_disagreement(after) < EXACT
        assert angle_energy(after) <= angle_energy(before) * (1 + 1e-12)
        triangles = after.surface.triangles
        edges, count = np.unique(
            np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2),
            axis=0,
            return_counts=True,
        )
        fixed = np.isin(after.surface.corner_vertices, edges[count == 1])
        assert (after.uv[fixed, 1] == before.uv[fixed, 1]).all()
    assert harmonic[0].drift.max() < SOLVER


def test_harmonic_maps_need_straight_boundaries():
    surface = surface_of(OPEN["genus 0, 2 loops"])
    uv = surface.vertices[surface.corner_vertices][:, :2]
    with pytest.raises(InvalidMesh, match="v changes along the boundary edge between vertices"):
        ProgressiveMesh(surface).levels_of_detail(uv, [100], harmonic=True)


# ---- discretisation --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", REAL)
def test_drift_of_harmonic_levels_falls_with_the_edge_length(name):
    """Against the map of the original, whose UV area is 1; the finest level is the original's triangulation."""
    mesh, structure = progressive(name), structure_of(name)
    uv = structure.uv(structure.balanced_coefficients())
    count = len(mesh.level(2**31).triangles)
    levels = mesh.levels_of_detail(uv, [count // 4**k for k in range(4)], harmonic=True)
    root_mean_square = [np.sqrt(np.mean(level.drift**2)) for level in levels]
    assert root_mean_square[0] < SOLVER
    assert root_mean_square[1] < 0.01
    for fine, coarse in zip(root_mean_square[1:], root_mean_square[2:]):
        assert fine < 0.6 * coarse


# ---- the same input, the same bits; what is refused ------------------------------------------------------------------


def test_deterministic_at_any_number_of_threads():
    uv = integer_map("genus 8 block")
    mesh = progressive("genus 8 block")
    one, two = (mesh.levels_of_detail(uv, [900, 300], harmonic=True, threads=t) for t in (1, 2))
    for a, b in zip(one, two):
        assert a.uv.tobytes() == b.uv.tobytes()


def test_levels_come_in_the_order_asked_for():
    mesh = progressive("torus of triangles")
    levels = mesh.levels_of_detail(integer_map("torus of triangles"), [100, 400, 100])
    assert [len(level.surface.triangles) for level in levels] == [100, 400, 100]
    assert levels[0].uv.tobytes() == levels[2].uv.tobytes()


def test_wrong_uvs_are_refused():
    mesh, uv = progressive("torus of quads"), integer_map("torus of quads")
    with pytest.raises(InvalidMesh, match=r"has the shape \(3, 2\); .* is needed"):
        mesh.levels_of_detail(uv[:3], [100])
    with pytest.raises(InvalidMesh, match="shape"):
        mesh.levels_of_detail(uv[:, 0], [100])
    broken = uv.copy()
    broken[17, 1] = np.nan
    with pytest.raises(InvalidMesh, match="uv of corner 17 is not finite"):
        mesh.levels_of_detail(broken, [100])


def test_harmonic_maps_need_translations_across_seams():
    mesh, uv = progressive("torus of quads"), integer_map("torus of quads").copy()
    uv[:4] *= 1.5
    with pytest.raises(InvalidMesh, match="across the edge between vertices .* rotated or scaled"):
        mesh.levels_of_detail(uv, [2**31], harmonic=True)


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (families.cube(), "genus 0 and 0 boundaries"),
        (families.hemisphere(4), "genus 0 and 1 boundary"),
        (families.united(families.torus(10, 8), families.torus(8, 6)), "2 components"),
    ],
)
def test_harmonic_maps_need_handles_or_two_boundary_loops(mesh, words):
    surface = surface_of(mesh)
    uv = surface.vertices[surface.corner_vertices][:, :2]
    with pytest.raises(TopologyError, match=words):
        ProgressiveMesh(surface).levels_of_detail(uv, [30], harmonic=True)


def test_options_and_cancelling():
    mesh, uv = progressive("torus of quads"), integer_map("torus of quads")
    with pytest.raises(ValueError, match="solver is 'none'"):
        mesh.levels_of_detail(uv, [100], solver="none")
    with pytest.raises(Cancelled):
        mesh.levels_of_detail(uv, [400, 100], harmonic=True, progress=lambda fraction, stage: False)
    seen = []
    mesh.levels_of_detail(uv, [400, 100], harmonic=True, progress=lambda fraction, stage: seen.append(fraction))
    assert seen == sorted(seen) and seen[-1] == 1
