"""Any polygons are cut until they are a surface: every face is in it, and nothing is cut without need."""

import json
import runpy
from collections import defaultdict
from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, TopologyError, __main__, automatic_structure, conformal_structure
from repository import SHARED

TORUS = families.torus(6, 5)
TETRAHEDRON = families.tetrahedron()
CUBE = families.cube()
DISK = families.hemisphere(3)


def lenient(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False)


def faces_of(mesh):
    return [face.tolist() for face in mesh.faces]


def with_faces(mesh, *more):
    return families.polygons(mesh.vertices, [*faces_of(mesh), *map(list, more)])


def joined_at_a_vertex(*parts):
    """Vertex 0 of every part is one."""
    mesh, first = parts[0], len(parts[0].vertices)
    for part in parts[1:]:
        both = families.united(mesh, part)
        corners = np.where(both.corners == first, 0, both.corners)
        corners -= corners > first
        mesh = replace(both, corners=corners, vertices=np.delete(both.vertices, first, axis=0))
        first = len(mesh.vertices)
    return mesh


def fin(mesh):
    """A third face on an edge."""
    a, b = mesh.faces[0][:2]
    points = np.concatenate([mesh.vertices, [[9.0, 9, 9]]])
    return with_faces(replace(mesh, vertices=points), (a, b, len(points) - 1))


def book(pages):
    """Triangles around one edge, in no order."""
    angle = 2 * np.pi * np.random.default_rng(pages).permutation(pages) / pages
    points = [[0, 0, 0], [0, 0, 1], *np.stack([np.cos(angle), np.sin(angle), 0.5 + 0 * angle], axis=1)]
    return families.polygons(points, [[0, 1, page + 2] for page in range(pages)])


def stacked(mesh, *others):
    """Further faces on the same vertices: copies as they are (1) or reversed (-1)."""
    return with_faces(mesh, *(face[::step] for step in others for face in faces_of(mesh)))


def shared_wall():
    """Two rooms with the wall between them."""
    right = [[4, 8, 9, 5], [6, 7, 11, 10], [4, 6, 10, 8], [5, 9, 11, 7], [8, 10, 11, 9]]
    x, y, z = np.meshgrid([0, 1, 2], [0, 1], [0, 1], indexing="ij")
    left = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return families.polygons(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), left + right)


def frame():
    """A square with a square hole as one polygon, and walls around both: a ring of genus 1 but for its lower side."""
    outer, inner = [[0, 0], [3, 0], [3, 3], [0, 3]], [[1, 1], [2, 1], [2, 2], [1, 2]]
    points = [[x, y, z] for z in (1, 0) for x, y in outer + inner]
    cap = [0, 1, 2, 3, 0, 4, 7, 6, 5, 4]
    walls = [[i, 8 + i, 8 + (i + 1) % 4, (i + 1) % 4] for i in range(4)]
    walls += [[4 + i, 4 + (i + 1) % 4, 12 + (i + 1) % 4, 12 + i] for i in range(4)]
    return families.polygons(points, [cap, *walls])


def soup(seed):
    """Random polygons on a few vertices; some meet a vertex more than once, or have too few."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 9))
    most = min(count, 5)
    faces = [[0, 1, 2]]
    for _ in range(int(rng.integers(1, 25))):
        size = int(rng.integers(3, most + 1))
        is_simple = rng.random() < 0.9
        faces.append((rng.permutation(count)[:size] if is_simple else rng.integers(0, count, size)).tolist())
    return families.polygons(rng.normal(size=(count, 3)), faces)


def voxels(seed, size=6):
    """Cubes that touch at edges and corners."""
    return families.voxel_surface(np.random.default_rng(seed).random((size, size, size)) < 0.45)


def cubes(*cells):
    filled = np.zeros(np.max(cells, axis=0) + 1, bool)
    filled[tuple(np.transpose(cells))] = True
    return families.voxel_surface(filled)


def projective_plane():
    faces = [
        (0, 1, 2),
        (0, 2, 3),
        (0, 3, 4),
        (0, 4, 5),
        (0, 5, 1),
        (1, 2, 4),
        (2, 3, 5),
        (3, 4, 1),
        (4, 5, 2),
        (5, 1, 3),
    ]
    return families.polygons(np.random.default_rng(2).normal(size=(6, 3)), faces)


BAD = {
    "fin": fin(TORUS),
    "fin on a cube": fin(CUBE),
    **{f"book of {pages}": book(pages) for pages in (3, 4, 5, 8, 100)},
    "shared wall": shared_wall(),
    "moebius": families.moebius(),
    "klein bottle": families.klein_bottle(),
    "projective plane": projective_plane(),
    "moebius, some faces reversed": families.partly_reversed(families.moebius()),
    "twice": stacked(TORUS, 1),
    "two sides": stacked(TORUS, -1),
    "three layers": stacked(families.geodesic_sphere(2), 1, -1),
    "one face twice": with_faces(TORUS, TORUS.faces[7]),
    "two sides of a leaf": stacked(DISK, -1),
    "one-sided and doubled": stacked(families.moebius(), 1),
    "face with a hole": frame(),
    "spike": with_faces(CUBE, (0, 1, 6, 3, 6)),
    "vertex again at once": with_faces(CUBE, (0, 0, 1, 6)),
    "touching": joined_at_a_vertex(TETRAHEDRON, CUBE, TORUS),
    **{f"voxels {seed}": voxels(seed) for seed in range(4)},
    **{f"soup {seed}": soup(seed) for seed in range(60)},
}


def sides_by_edge(corners, offsets):
    """{pair of vertices, lower first: [(face, corner, next corner)]}"""
    found = defaultdict(list)
    for face, (first, last) in enumerate(zip(offsets[:-1], offsets[1:], strict=True)):
        for corner in range(first, last):
            following = corner + 1 if corner + 1 < last else first
            pair = sorted((int(corners[corner]), int(corners[following])))
            found[tuple(pair)].append((face, corner, following))
    return found


def cuts_by_reason(surface):
    return {cut.reason: cut for cut in surface.repairs.cuts}


def without_repeats(mesh):
    """The mesh whose corners follow no other one at their vertex, and the corners of the given one that these are."""
    before = np.arange(len(mesh.corners)) - 1
    before[mesh.offsets[:-1]] = mesh.offsets[1:] - 1
    is_kept = mesh.corners != mesh.corners[before]
    offsets = np.concatenate([[0], np.cumsum(is_kept)])[mesh.offsets]
    return replace(mesh, corners=mesh.corners[is_kept], offsets=offsets), np.flatnonzero(is_kept)


def check_indices(surface, given):
    """Every element is the one that its index names."""
    mesh, kept = without_repeats(given)
    corner_index = np.searchsorted(kept, surface.corner_index)
    assert (kept[corner_index] == surface.corner_index).all()
    assert (surface.vertices == mesh.vertices[surface.vertex_index]).all()
    assert (surface.vertex_index[surface.corner_vertices] == mesh.corners[corner_index]).all()
    assert (np.diff(surface.face_offsets) == np.diff(mesh.offsets)[surface.face_index]).all()
    starts = mesh.offsets[surface.face_index]
    within = np.arange(len(surface.corner_index)) - np.repeat(surface.face_offsets[:-1], np.diff(surface.face_offsets))
    assert (corner_index == np.repeat(starts, np.diff(surface.face_offsets)) + within).all()
    assert (np.diff(surface.vertex_index) >= 0).all()


@pytest.mark.parametrize("name", BAD)
def test_the_result_is_a_surface_of_all_faces(name):
    mesh = BAD[name]
    surface = lenient(mesh)
    check_indices(surface, mesh)
    usable = [f for f, face in enumerate(faces_of(mesh)) if len(set(face)) >= 3]
    left_out = [int(f) for refused in surface.refused for f in refused.faces]
    flat = [f for f in left_out if f in usable]  # soups have faces that run back on themselves
    assert sorted([*surface.face_index.tolist(), *flat]) == usable
    assert not flat or name.startswith("soup")
    alone = Surface.from_polygons(surface.vertices, surface.corner_vertices, surface.face_offsets)  # strict
    assert alone.is_whole and (alone.triangles == surface.triangles).all()
    for part in surface.components:
        check_indices(part, mesh)
        assert part.boundary_count >= 0 and part.genus >= 0


@pytest.mark.parametrize("name", BAD)
def test_nothing_is_cut_without_a_reason(name):
    """Two faces that have an edge alone keep it, unless a cut names it or one of them."""
    surface = lenient(BAD[name])
    mesh, kept = without_repeats(BAD[name])
    cuts = cuts_by_reason(surface)
    assert cuts or name.startswith("soup") or name == "vertex again at once"
    edges = {tuple(pair) for cut in cuts.values() for pair in cut.edges.tolist()}
    apart = {int(f) for cut in cuts.values() for f in cut.faces} | {int(f) for r in surface.refused for f in r.faces}
    vertex_of = np.full(len(mesh.corners), -1)
    vertex_of[np.searchsorted(kept, surface.corner_index)] = surface.corner_vertices
    for pair, sides in sides_by_edge(mesh.corners, mesh.offsets).items():
        own = [side for side in sides if side[0] not in apart]
        if len(own) == 2 and len(sides) == 2 and pair not in edges:
            (_, a, b), (_, c, d) = own
            assert set(vertex_of[[a, b]]) == set(vertex_of[[c, d]])


@pytest.mark.parametrize("name", ["voxels 0", "klein bottle", "three layers", "soup 3"])
def test_the_same_mesh_is_cut_in_the_same_way(name):
    one, other = lenient(BAD[name]), lenient(BAD[name])
    assert (one.corner_vertices == other.corner_vertices).all()
    assert repr(one.repairs) == repr(other.repairs)


@pytest.mark.parametrize("mesh", [TORUS, CUBE, families.cylinder(8, 3), families.partly_reversed(TORUS)])
def test_a_surface_stays_what_it_is(mesh):
    surface = lenient(mesh)
    assert surface.is_whole and not surface.refused and not surface.repairs.cuts
    assert (surface.vertices == mesh.vertices).all() and (surface.corner_vertices == mesh.corners).all()
    assert (surface.vertex_index == np.arange(len(mesh.vertices))).all()


@pytest.mark.parametrize("name", BAD)
def test_what_was_cut_is_not_cut_again(name):
    surface = lenient(BAD[name])
    again = Surface.from_polygons(surface.vertices, surface.corner_vertices, surface.face_offsets, strict=False)
    assert not again.repairs.cuts


# ---- edges with three faces or more ---------------------------------------------------------------------------------


@pytest.mark.parametrize("body", [TORUS, CUBE, families.geodesic_sphere(2)])
def test_a_fin_leaves_the_body_closed(body):
    surface = lenient(fin(body))
    whole, single = surface.components
    assert whole.genus == Surface.from_polygons(body.vertices, body.corners, body.offsets).genus
    assert whole.boundary_count == 0 and single.face_index.tolist() == [body.face_count]
    assert cuts_by_reason(surface)["many_faces"].edges.tolist() == [sorted(body.faces[0][:2].tolist())]


@pytest.mark.parametrize("pages", [3, 4, 5, 8, 9])
def test_pages_are_joined_in_pairs_that_lie_opposite(pages):
    mesh = book(pages)
    parts = lenient(mesh).components
    sizes = sorted(len(part.face_index) for part in parts)
    assert sizes == [1] * (pages % 2) + [2] * (pages // 2)
    for part in parts:
        if len(part.face_index) == 2 and pages % 2 == 0:
            assert np.allclose(mesh.vertices[part.face_index + 2, :2].sum(axis=0), 0)


def test_more_faces_than_are_paired_are_all_apart():
    assert len(lenient(book(100)).components) == 100


def test_the_wall_between_two_rooms_comes_off():
    sizes = [(len(part.face_index), part.boundary_count) for part in lenient(shared_wall()).components]
    assert sizes == [(10, 0), (1, 1)]


def test_cubes_that_touch_along_an_edge_part_there():
    parts = lenient(cubes((0, 0, 0), (1, 1, 0))).components
    assert [(part.genus, part.boundary_count, len(part.face_index)) for part in parts] == [(0, 0, 6)] * 2


def test_a_ring_of_cubes_keeps_one_copy_of_each_edge():
    """The two cubes at an edge touch there, and are joined by others above and below: the edge cannot be doubled."""
    cells = [(0, 0, 1), (1, 1, 1)] + [(x, y, z) for z in (0, 2) for x in (0, 1) for y in (0, 1)]
    surface = lenient(cubes(*cells))
    (part,) = surface.components
    assert part.boundary_count == 0


# ---- faces that stand twice -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("step, reason", [(1, "twice"), (-1, "opposite")])
@pytest.mark.parametrize("mesh", [TORUS, families.geodesic_sphere(2), DISK])
def test_each_layer_is_a_surface_of_its_own(mesh, step, reason):
    surface = lenient(stacked(mesh, step))
    alone = Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)
    kinds = [(part.genus, part.boundary_count) for part in surface.components]
    assert kinds == [(alone.genus, alone.boundary_count)] * 2
    (cut,) = surface.repairs.cuts
    assert cut.reason == reason and cut.faces.tolist() == list(range(mesh.face_count, 2 * mesh.face_count))


def test_one_face_twice_leaves_the_rest_whole():
    torus, single = lenient(BAD["one face twice"]).components
    assert torus.genus == 1 and torus.boundary_count == 0 and single.face_index.tolist() == [30]


# ---- one-sided parts ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_moebius_strip_becomes_a_disk(seed):
    mesh = families.moebius(16, 3)
    surface = lenient(mesh if seed is None else families.partly_reversed(mesh, seed=seed))
    (disk,) = surface.components
    assert (disk.genus, disk.boundary_count) == (0, 1)
    assert len(cuts_by_reason(surface)["one_sided"].edges) == 3  # straight across


@pytest.mark.parametrize("mesh, characteristic", [(families.klein_bottle(), 0), (projective_plane(), 1)])
def test_a_closed_one_sided_part_is_cut_along_a_loop(mesh, characteristic):
    """Cutting along loops does not change the Euler characteristic; their vertices are doubled."""
    surface = lenient(mesh)
    (part,) = surface.components
    assert part.euler_characteristic == characteristic and part.boundary_count > 0


# ---- polygons that meet themselves or each other ---------------------------------------------------------------------


def test_a_face_with_a_hole_stays_one_polygon():
    mesh = frame()
    surface = lenient(mesh)
    assert [len(part.face_index) for part in surface.components] == [1, 4, 4]
    cap = surface.components[0]
    assert (cap.genus, cap.boundary_count) == (0, 1) and np.isclose(cap.area, 8)
    assert cuts_by_reason(surface)["repeated"].faces.tolist() == [0]


def test_polygons_that_meet_in_two_edges_are_not_cut():
    """Two quadrilaterals around a vertex of two edges, and a ring of two."""
    lens = families.polygons([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 2, 1]], [[0, 1, 2, 3], [2, 1, 0, 4]])
    ring = families.polygons(
        [[x, y, z] for z in (0, 1) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))],
        [[0, 1, 2, 6, 5, 4], [2, 3, 0, 4, 7, 6]],
    )
    for mesh, boundaries in ((lens, 1), (ring, 2)):
        surface = lenient(mesh)
        assert surface.is_whole and surface.boundary_count == boundaries


# ---- fans that touch ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [2, 3, 5])
def test_fans_get_a_vertex_each(count):
    mesh = joined_at_a_vertex(*[TETRAHEDRON] * count)
    surface = lenient(mesh)
    check_indices(surface, mesh)
    (cut,) = surface.repairs.cuts
    assert cut.reason == "touching" and cut.vertices.tolist() == [0]
    assert len(surface.components) == count and not surface.refused
    assert (np.bincount(surface.vertex_index)[:1] == count).all()
    for part in surface.components:
        assert part.genus == 0 and part.boundary_count == 0


def test_a_surface_that_touches_itself_stays_one():
    """Two vertices of a torus far from one another become one."""
    corners = np.where(TORUS.corners == 17, 0, TORUS.corners)
    surface = lenient(replace(TORUS, corners=corners))
    assert cuts_by_reason(surface)["touching"].vertices.tolist() == [0]
    assert len(surface.components) == 1 and surface.genus == 1


# ---- what is left out -----------------------------------------------------------------------------------------------


def test_other_parts_are_as_they_are_alone():
    bad = fin(CUBE)
    mesh = families.united(TORUS, bad, TETRAHEDRON)
    surface = lenient(mesh)
    check_indices(surface, mesh)
    assert [len(part.face_index) for part in surface.components] == [30, bad.face_count - 1, 1, 4]
    for part in (surface.components[0], surface.components[-1]):
        alone = Surface.from_polygons(part.vertices, part.corner_vertices, part.face_offsets)
        expected, found = automatic_structure(alone), automatic_structure(part)
        assert (found.uv(found.balanced_coefficients()) == expected.uv(expected.balanced_coefficients())).all()


def broken(mesh, corner, value):
    corners = mesh.corners.astype(np.int64)
    corners[corner] = value
    return replace(mesh, corners=corners)


def with_nan(mesh):
    points = mesh.vertices.copy()
    points[3, 1] = np.nan
    return replace(mesh, vertices=points)


UNUSABLE = {
    "index out of range": (broken(TORUS, 4, 2**40), [1], f"face 1 names vertex {2**40}; numbers from 0 to below"),
    "negative index": (broken(TORUS, 4, -7), [1], "face 1 has the negative vertex index -7"),
    "not a number": (with_nan(TORUS), [2, 3, 27, 28], "vertex 3 has a coordinate that is not a number"),
    "two corners": (with_faces(TORUS, (0, 1)), [30], "face 30 has 2 corners; it needs at least 3"),
    "two vertices": (with_faces(TORUS, (0, 1, 0)), [30], "face 30 has vertex 0 twice"),
}


@pytest.mark.parametrize("name", UNUSABLE)
def test_faces_that_cannot_be_mapped_are_left_out_alone(name):
    mesh, faces, reason = UNUSABLE[name]
    surface = lenient(mesh)
    (refused,) = surface.refused
    if name == "not a number":
        faces = [f for f, face in enumerate(faces_of(mesh)) if 3 in face]
    assert refused.faces.tolist() == faces and refused.reason.startswith(reason)
    assert surface.face_index.tolist() == [f for f in range(mesh.face_count) if f not in faces]


def test_reasons_of_many_faces_are_one_entry():
    mesh = with_faces(with_nan(TORUS), (0, 1), (1, 2), (5, 5, 5), (6, 7, 6))
    refused = lenient(mesh).refused
    assert [len(one.faces) for one in refused] == [4, 4]
    assert refused[1].faces.tolist() == [30, 31, 32, 33] and refused[1].reason.startswith("face 30")


@pytest.mark.parametrize("beside", [TORUS, fin(CUBE)])
def test_parts_without_area_are_left_out(beside):
    flat = replace(TETRAHEDRON, vertices=TETRAHEDRON.vertices * [1, 0, 0])
    surface = lenient(families.united(flat, beside, flat))
    (refused,) = surface.refused
    count = beside.face_count
    assert refused.faces.tolist() == [0, 1, 2, 3, *range(count + 4, count + 8)]
    assert len(surface.face_index) == count and all(part.area > 0 for part in surface.components)


def test_faces_without_area_beside_others_stay():
    points = CUBE.vertices.copy()
    points[CUBE.faces[0][1]] = points[CUBE.faces[0][0]]
    surface = lenient(replace(CUBE, vertices=points))
    assert surface.is_whole and not surface.refused


HOPELESS = broken(TETRAHEDRON, slice(None), 99), replace(TORUS, vertices=TORUS.vertices * np.nan)


@pytest.mark.parametrize("mesh", HOPELESS)
def test_where_nothing_is_left_it_is_refused_as_ever(mesh):
    messages = []
    for strict in (True, False):
        with pytest.raises((InvalidMesh, TopologyError)) as caught:
            Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=strict)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


@pytest.mark.parametrize("mesh", [fin(TORUS), families.moebius(), stacked(TORUS, 1), frame(), with_nan(TORUS)])
def test_strict_surfaces_refuse_what_would_be_cut(mesh):
    with pytest.raises((InvalidMesh, TopologyError)):
        Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


def test_many_parts_take_linear_time():
    """A bad one among twenty thousand, and as many layers of one triangle; quadratic work would take minutes."""
    corners = np.arange(60_000)
    points = np.random.default_rng(1).normal(size=(60_000, 3))
    points[17] = np.inf
    surface = Surface.from_polygons(points, corners, np.arange(0, 60_001, 3), strict=False)
    assert [refused.faces.tolist() for refused in surface.refused] == [[5]]
    assert len(surface.components) == 19_999 and surface.is_unwelded
    layers = Surface.from_polygons(points[:3], corners % 3, np.arange(0, 60_001, 3), strict=False)
    assert len(layers.components) == 20_000


# ---- faces that are apart -------------------------------------------------------------------------------------------


def apart(mesh):
    """Every face with vertices of its own."""
    return replace(mesh, vertices=mesh.vertices[mesh.corners], corners=np.arange(len(mesh.corners)))


@pytest.mark.parametrize("mesh", [TORUS, CUBE, families.cylinder(9, 4), families.geodesic_sphere(3)])
def test_faces_that_are_apart_are_joined(mesh):
    """Copies of a vertex differ by less than single precision tells."""
    alone = Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)
    loose = apart(mesh)
    points = loose.vertices.astype(np.float32).astype(float)
    points *= 1 + 1e-12 * np.random.default_rng(0).normal(size=points.shape)
    surface = lenient(replace(loose, vertices=points))
    assert (surface.genus, surface.boundary_count) == (alone.genus, alone.boundary_count)
    assert len(surface.vertices) == len(mesh.vertices) and not surface.repairs.cuts
    joined = surface.repairs.joined_vertices
    assert len(joined) == len(loose.vertices) - len(mesh.vertices)
    assert not np.isin(joined, surface.vertex_index).any()
    assert (surface.corner_index == np.arange(len(mesh.corners))).all() and not surface.is_whole


def test_parts_that_only_touch_are_not_joined():
    """Apart, two tetrahedra that have a vertex at one place, and squares whose sides meet halfway."""
    two = apart(joined_at_a_vertex(TETRAHEDRON, TETRAHEDRON))
    surface = lenient(two)
    assert [(part.genus, part.boundary_count) for part in surface.components] == [(0, 0)] * 2
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    points = np.concatenate([square, square + [1, 0.5, 0]])
    assert len(lenient(families.polygons(points, [[0, 1, 2, 3], [4, 5, 6, 7]])).components) == 2


def test_what_is_mostly_whole_is_not_joined():
    """Seams of a mesh whose faces mostly have neighbours are left as they are."""
    surface = lenient(families.united(DISK, DISK))
    assert surface.is_whole and len(surface.components) == 2


# ---- meshes as people bring them -------------------------------------------------------------------------------------

HARD_CASES = SHARED / "tools" / "hard_cases.py"


@pytest.mark.skipif(not HARD_CASES.exists(), reason="no folder ../shared")
@pytest.mark.parametrize("seed", range(5))
def test_hard_cases_are_surfaces_of_all_faces(seed):
    """But of those at a vertex that is a million million times too far."""
    hard_cases = runpy.run_path(str(HARD_CASES))
    for name in hard_cases["NAMES"]:
        mesh = families.polygons(*hard_cases["make"](name, seed))
        surface = lenient(mesh)
        of_corners = np.repeat(np.arange(mesh.face_count), np.diff(mesh.offsets))
        wild = of_corners[mesh.corners == 7] if name == "wild" else np.empty(0, int)
        assert np.concatenate([wild[:0], *(refused.faces for refused in surface.refused)]).tolist() == wild.tolist()
        assert (surface.face_index == np.delete(np.arange(mesh.face_count), wild)).all()
        assert (surface.corner_index == np.flatnonzero(~np.isin(of_corners, wild))).all()
        assert Surface.from_polygons(surface.vertices, surface.corner_vertices, surface.face_offsets).is_whole
        reasons = cuts_by_reason(surface).keys() - {"touching"}  # flat shapes touch themselves
        assert bool(reasons) == (name in CUT_CASES), name


CUT_CASES = ("fin", "double_sided", "shared_wall", "bracket", "voxels", "one_sided")


# ---- files and the command ------------------------------------------------------------------------------------------


def write_obj(path, mesh):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in mesh.faces]
    path.write_text("\n".join(lines) + "\n")


def test_files(tmp_path):
    path = tmp_path / "mesh.obj"
    write_obj(path, joined_at_a_vertex(TETRAHEDRON, TETRAHEDRON))
    assert len(Surface.read(path).components) == 2
    with pytest.raises(InvalidMesh, match="vertex 0 is non-manifold"):
        Surface.read(path, strict=True)


def test_welding(tmp_path):
    path = tmp_path / "mesh.obj"
    write_obj(path, apart(TORUS))
    unwelded = Surface.read(path, strict=True)
    assert len(unwelded.components) == 30
    with pytest.raises(TopologyError, match="strict=False"):
        conformal_structure(unwelded)
    welded = Surface.read(path, weld=True)
    assert welded.genus == 1 and len(welded.vertices) == 30 and not welded.is_unwelded


def test_welding_leaves_out_what_it_collapses(tmp_path):
    """A quad with two corners at one place becomes a triangle, one with two pairs of them nothing."""
    path = tmp_path / "mesh.obj"
    points = CUBE.vertices.copy()
    a, b = CUBE.faces[0][:2]
    points[b] = points[a]
    write_obj(path, apart(replace(CUBE, vertices=points)))
    welded = Surface.read(path, weld=True)
    assert welded.genus == 0 and welded.boundary_count == 0 and len(welded.vertices) == 7
    assert sorted(np.diff(welded.face_offsets).tolist()) == [3, 3, 4, 4, 4, 4]


def test_triangles_that_welding_collapses_leave_an_stl_closed(tmp_path):
    """The sliver between two points that are one in single precision."""
    path = tmp_path / "mesh.stl"
    sphere = families.geodesic_sphere(2)
    points = sphere.vertices.copy()
    a, b = sphere.faces[0][:2]
    points[b] = points[a]
    text = ["solid x"]
    for face in sphere.faces:
        corners = "\n".join(f"vertex {x!r} {y!r} {z!r}" for x, y, z in points[face].tolist())
        text.append(f"facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet")
    path.write_text("\n".join([*text, "endsolid x", ""]))
    surface = Surface.read(path)
    assert surface.genus == 0 and surface.boundary_count == 0
    assert len(surface.vertices) == len(points) - 1 and len(surface.triangles) == len(sphere.faces) - 2


def test_the_command_maps_every_face_and_tells_of_cuts(tmp_path, capsys):
    path = tmp_path / "mesh.obj"
    write_obj(path, families.united(fin(CUBE), TORUS))
    assert __main__.main([str(path)]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [part["done"] for part in report["components"]] == [True] * 3
    (cut,) = report["repairs"]["cuts"]
    assert cut["count"] == 1 and cut["text"] == "cut along 1 edge that has three or more faces"
