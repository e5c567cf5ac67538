"""What is done of a mesh that is no surface as a whole."""

import json
import re
from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, TopologyError, __main__, automatic_structure, conformal_structure, log_map

TORUS = families.torus(6, 5)
TETRAHEDRON = families.tetrahedron()


def lenient(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False)


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


def with_face(mesh, *corners):
    return families.polygons(mesh.vertices, [*(face.tolist() for face in mesh.faces), list(corners)])


def fin(mesh):
    """A third face on an edge."""
    a, b = mesh.faces[0][:2]
    points = np.concatenate([mesh.vertices, [[9.0, 9, 9]]])
    return with_face(replace(mesh, vertices=points), a, b, len(points) - 1)


def check_indices(surface, mesh):
    """Every element is the one that its index names."""
    assert (surface.vertices == mesh.vertices[surface.vertex_index]).all()
    assert (surface.vertex_index[surface.corner_vertices] == mesh.corners[surface.corner_index]).all()
    assert (np.diff(surface.face_offsets) == np.diff(mesh.offsets)[surface.face_index]).all()


def test_a_sound_mesh_is_what_it_is():
    surface = lenient(TORUS)
    assert surface.is_whole and not surface.refused and not surface.repairs
    assert (surface.vertex_index == np.arange(30)).all()
    assert (surface.corner_vertices == TORUS.corners).all()


@pytest.mark.parametrize("count", [2, 3, 5])
def test_fans_get_a_vertex_each(count):
    mesh = joined_at_a_vertex(*[TETRAHEDRON] * count)
    surface = lenient(mesh)
    check_indices(surface, mesh)
    assert surface.repairs.split_vertices.tolist() == [0]
    assert len(surface.components) == count and not surface.refused
    assert (np.bincount(surface.vertex_index)[:1] == count).all()
    for part in surface.components:
        check_indices(part, mesh)
        assert part.genus == 0 and part.boundary_count == 0


def test_a_surface_that_touches_itself_stays_one():
    """Two vertices of a torus far from one another become one."""
    corners = np.where(TORUS.corners == 17, 0, TORUS.corners)
    surface = lenient(replace(TORUS, corners=corners))
    assert surface.repairs.split_vertices.tolist() == [0]
    assert len(surface.components) == 1 and surface.genus == 1


def test_sound_components_are_those_of_a_sound_mesh():
    bad = fin(families.cube())
    mesh = families.united(TORUS, bad, TETRAHEDRON)
    surface = lenient(mesh)
    check_indices(surface, mesh)
    assert [len(part.face_index) for part in surface.components] == [30, 4]
    (refused,) = surface.refused
    assert refused.faces.tolist() == list(range(30, 30 + len(bad.faces)))
    a, b = sorted(int(v) + 30 for v in bad.faces[0][:2])
    assert refused.reason == f"the edge between vertices {a} and {b} has 3 faces; a surface has at most 2"
    for part in surface.components:
        check_indices(part, mesh)
        alone = Surface.from_polygons(part.vertices, part.corner_vertices, part.face_offsets)
        assert alone.is_whole
        expected = automatic_structure(alone)
        found = automatic_structure(part)
        assert (found.uv(found.balanced_coefficients()) == expected.uv(expected.balanced_coefficients())).all()


def broken(mesh, corner, value):
    corners = mesh.corners.astype(np.int64)
    corners[corner] = value
    return replace(mesh, corners=corners)


def with_nan(mesh):
    points = mesh.vertices.copy()
    points[3, 1] = np.nan
    return replace(mesh, vertices=points)


SHIFT = len(TETRAHEDRON.faces)
BAD = {
    "index out of range": (lambda m: broken(m, 4, 2**40), f"face {SHIFT + 1} names vertex {2**40}, but there are only"),
    "negative index": (lambda m: broken(m, 4, -7), f"face {SHIFT + 1} has the negative vertex index"),
    "twice in a face": (lambda m: broken(m, 4, m.corners[5]), f"face {SHIFT + 1} has vertex .* twice"),
    "not a number": (with_nan, "vertex 7 has a coordinate that is not a number"),
    "duplicate face": (lambda m: with_face(m, *m.faces[0]), f"faces {SHIFT} and {SHIFT + 30} have the same vertices"),
    "no area": (lambda m: replace(m, vertices=m.vertices * [1, 0, 0]), rf"zero area \(face {SHIFT} is the first\)"),
    "one-sided": (lambda m: families.moebius(), "non-orientable: .* the edge between vertices"),
}


@pytest.mark.parametrize("name", BAD)
def test_each_fault_is_named_and_the_rest_is_done(name):
    make, reason = BAD[name]
    bad = make(TORUS)
    mesh = families.united(TETRAHEDRON, replace(bad, corners=np.where(bad.corners >= 2**30, 0, bad.corners)))
    first = TETRAHEDRON.corners.size
    corners = mesh.corners.astype(np.int64)
    wrong = (bad.corners >= 2**30) | (bad.corners < 0)
    corners[first:][wrong] = bad.corners[wrong]
    mesh = replace(mesh, corners=corners)
    surface = lenient(mesh)
    if name == "no area":  # a mesh with other faces that have one is no fault as a whole
        assert not surface.refused
        return
    (refused,) = surface.refused
    assert re.search(reason, refused.reason), refused.reason
    assert surface.face_index.tolist() == [0, 1, 2, 3]
    assert log_map(surface).uv([1.0]).shape == (12, 2)


@pytest.mark.parametrize("mesh", [fin(TORUS), families.moebius(), with_nan(TORUS), broken(TORUS, 4, 99)])
def test_nothing_sound_is_refused_as_ever(mesh):
    messages = []
    for strict in (True, False):
        with pytest.raises((InvalidMesh, TopologyError)) as caught:
            Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=strict)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


def test_many_parts_take_linear_time():
    """A bad one among ten thousand; quadratic work would take minutes."""
    one = np.arange(3)
    corners = (one + 3 * np.arange(20_000)[:, None]).ravel()
    points = np.random.default_rng(1).normal(size=(60_000, 3))
    points[17] = np.inf
    surface = Surface.from_polygons(points, corners, np.arange(0, 60_001, 3), strict=False)
    assert [refused.faces.tolist() for refused in surface.refused] == [[5]]
    assert len(surface.components) == 19_999 and surface.is_unwelded


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


def apart(mesh):
    """Every face with vertices of its own."""
    return replace(mesh, vertices=mesh.vertices[mesh.corners], corners=np.arange(len(mesh.corners)))


def test_welding(tmp_path):
    path = tmp_path / "mesh.obj"
    write_obj(path, apart(TORUS))
    unwelded = Surface.read(path)
    assert len(unwelded.components) == 30
    with pytest.raises(TopologyError, match="weld=True"):
        conformal_structure(unwelded)
    welded = Surface.read(path, weld=True)
    assert welded.genus == 1 and len(welded.vertices) == 30 and not welded.is_unwelded


def test_welding_leaves_out_what_it_collapses(tmp_path):
    """A quad with two corners at one place becomes a triangle, one with two pairs of them nothing."""
    path = tmp_path / "mesh.obj"
    cube = families.cube()
    points = cube.vertices.copy()
    a, b = cube.faces[0][:2]
    points[b] = points[a]
    write_obj(path, apart(replace(cube, vertices=points)))
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


def test_command_line_does_the_sound_parts(tmp_path, capsys):
    path = tmp_path / "mesh.obj"
    write_obj(path, families.united(fin(families.cube()), TORUS))
    assert __main__.main([str(path)]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [part["done"] for part in report["components"]] == [True, False]
    assert report["components"][1]["faces"] == 7 and "3 faces" in report["components"][1]["reason"]
    assert report["repairs"]["split_vertices"] == {"count": 0, "first": []}
