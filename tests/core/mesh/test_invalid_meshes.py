"""Every mesh that is refused, with the message that names the first bad element."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Error, InvalidMesh, Surface, TopologyError

TORUS = families.torus(6, 5)
QUADS = TORUS.corners.reshape(-1, 4)


def with_faces(*extra, vertices=TORUS.vertices):
    """The torus and more polygons."""
    return families.polygons(vertices, [*QUADS.tolist(), *extra])


def with_corner(corner, vertex):
    corners = TORUS.corners.copy()
    corners[corner] = vertex
    return replace(TORUS, corners=corners)


def with_coordinate(value):
    points = TORUS.vertices.copy()
    points[7, 1] = value
    return replace(TORUS, vertices=points)


def pinched():
    """Two tetrahedra that share one vertex."""
    one = families.tetrahedron()
    both = families.united(one, one)
    corners = np.where(both.corners == 4, 0, both.corners)
    return replace(
        both, corners=np.where(corners > 4, corners - 1, corners), vertices=np.delete(both.vertices, 4, axis=0)
    )


def three_at_an_edge():
    """One more triangle on an edge of the torus, with a third vertex of its own."""
    points = np.concatenate([TORUS.vertices, [[5.0, 5, 5]]])
    return with_faces([int(QUADS[3, 0]), int(QUADS[3, 1]), 30], vertices=points)


INVALID = {
    "negative index": (with_corner(9, -1), r"face 2 .*-1"),
    "index out of range": (with_corner(9, 30), r"face 2 .*30"),
    "enormous index": (with_corner(9, 2**40), rf"face 2 .*{2**40}"),
    "vertex twice in a face": (with_corner(9, QUADS[2, 0]), rf"face 2 .*vertex {QUADS[2, 0]} twice"),
    "not a number": (with_coordinate(np.nan), r"vertex 7 "),
    "infinite": (with_coordinate(-np.inf), r"vertex 7 "),
    "two corners": (with_faces([0, 1]), r"face 30 .*2 corners"),
    "no corners": (with_faces([]), r"face 30 .*0 corners"),
    "duplicate face": (with_faces(QUADS[4].tolist()), r"face(s)? .*\b4\b.*\b30\b|face(s)? .*\b30\b.*\b4\b"),
    "duplicate face, turned": (with_faces(np.roll(QUADS[4], 1).tolist()), r"\b4\b.*\b30\b|\b30\b.*\b4\b"),
    "duplicate face, reversed": (with_faces(QUADS[4, ::-1].tolist()), r"\b4\b.*\b30\b|\b30\b.*\b4\b"),
    "three faces at an edge": (
        three_at_an_edge(),
        rf"vertices {min(QUADS[3, :2])} and {max(QUADS[3, :2])} has 3 faces",
    ),
    "pinched vertex": (pinched(), r"vertex 0 "),
    "no faces": (replace(TORUS, corners=TORUS.corners[:0], offsets=TORUS.offsets[:1]), r"no faces"),
    "no area": (replace(TORUS, vertices=0 * TORUS.vertices), r"area"),
    "all on a line": (replace(TORUS, vertices=TORUS.vertices * [1, 0, 0]), r"area"),
}


@pytest.mark.parametrize("integers", [np.int32, np.int64])
@pytest.mark.parametrize("name", INVALID)
def test_is_refused_and_named(name, integers):
    mesh, message = INVALID[name]
    corners = mesh.corners if name == "enormous index" else mesh.corners.astype(integers)
    with pytest.raises(InvalidMesh, match=message) as caught:
        Surface.from_polygons(mesh.vertices, corners, mesh.offsets.astype(integers))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("integers", [np.int32, np.int64])
@pytest.mark.parametrize("face", [3, 29])
def test_offsets_of_any_size_are_refused(integers, face):
    for wrong in (np.iinfo(integers).min, -1, np.iinfo(integers).max):
        offsets = TORUS.offsets.astype(integers)
        offsets[face] = wrong
        with pytest.raises(InvalidMesh, match="face_offsets decrease at face"):
            Surface.from_polygons(TORUS.vertices, TORUS.corners.astype(integers), offsets)


LARGE = families.torus(300, 200)  # its edges are found in blocks of vertices, its polygons checked in batches


def large_with(vertices, *extra):
    return families.polygons(vertices, [*LARGE.corners.reshape(-1, 4).tolist(), *extra])


def test_first_bad_element_of_a_large_mesh_is_named():
    a, b = (int(v) for v in LARGE.corners[4 * 40_000 : 4 * 40_000 + 2])
    one_more = np.concatenate([LARGE.vertices, [[5.0, 5, 5]]])
    cases = [
        (large_with(one_more, [a, b, 60_000]), rf"edge between vertices {min(a, b)} and {max(a, b)} has 3 faces"),
        (large_with(LARGE.vertices, LARGE.corners[-4:].tolist()), r"faces 59999 and 60000 "),
        (
            replace(LARGE, vertices=np.where(np.arange(60_000)[:, None] >= 50_000, np.nan, LARGE.vertices)),
            r"vertex 50000 ",
        ),
        (replace(LARGE, corners=np.where(np.arange(240_000) >= 4 * 30_001, -1, LARGE.corners)), r"face 30001 .*-1"),
    ]
    for mesh, message in cases:
        with pytest.raises(InvalidMesh, match=message):
            Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


@pytest.mark.parametrize("name", ["negative index", "not a number", "two corners", "pinched vertex", "duplicate face"])
def test_lists_give_the_same_message(name):
    mesh, _ = INVALID[name]
    with pytest.raises(InvalidMesh) as from_arrays:
        Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)
    with pytest.raises(InvalidMesh) as from_lists:
        Surface(mesh.vertices, [face.tolist() for face in mesh.faces])
    assert str(from_arrays.value) == str(from_lists.value)


@pytest.mark.parametrize("mesh", [families.moebius(), families.klein_bottle()], ids=["Moebius strip", "Klein bottle"])
def test_one_sided_surfaces_are_refused(mesh):
    with pytest.raises(TopologyError, match="orient"):
        Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


WRONG_ARRAYS = {
    "vertices of two columns": (TORUS.vertices[:, :2], QUADS, "vertices"),
    "flat vertices": (TORUS.vertices.ravel(), QUADS, "vertices"),
    "vertices of words": ([["a", "b", "c"]], [[0, 0, 0]], "vertices"),
    "no vertices": (np.zeros((0, 3)), QUADS, r"face 0 "),
    "real indices": (TORUS.vertices, QUADS.astype(float), "integers"),
    "bool indices": (TORUS.vertices, QUADS.astype(bool), "integers"),
    "flat faces": (TORUS.vertices, QUADS.ravel(), "faces"),
    "faces of two columns": (TORUS.vertices, QUADS[:, :2], "faces"),
    "faces of no columns": (TORUS.vertices, np.zeros((3, 0), int), "faces"),
    "one face as a row": (TORUS.vertices, np.arange(5), "faces"),
    "list of integers": (TORUS.vertices, [0, 1, 2], "faces"),
    "list of real lists": (TORUS.vertices, [[0, 1, 2.5]], "integers"),
    "empty list": (TORUS.vertices, [], "no faces"),
    "empty array": (TORUS.vertices, np.zeros((0, 3), int), "no faces"),
    "index beyond 64 bits": (TORUS.vertices, np.full((1, 3), 2**64 - 1, dtype=np.uint64), "64"),
    "index beyond any type": (TORUS.vertices, [[0, 1, 2**70]], "integer"),
}


@pytest.mark.parametrize("name", WRONG_ARRAYS)
def test_wrong_arrays(name):
    vertices, faces, message = WRONG_ARRAYS[name]
    with pytest.raises(InvalidMesh, match=message):
        Surface(vertices, faces)


WRONG_OFFSETS = {
    "decreasing": ([0, 8, 4, *TORUS.offsets[3:]], "face 1"),
    "not from zero": ([1, *TORUS.offsets[1:]], "from 1"),
    "not to the end": (TORUS.offsets[:-1], "120"),
    "beyond the end": ([*TORUS.offsets[:-1], 124], "124"),
    "empty": (np.zeros(0, int), "no faces"),
    "one": ([0], "no faces"),
    "real": (TORUS.offsets.astype(float), "integers"),
    "two dimensions": (TORUS.offsets[None], "face_offsets"),
}


@pytest.mark.parametrize("name", WRONG_OFFSETS)
def test_wrong_offsets(name):
    offsets, message = WRONG_OFFSETS[name]
    with pytest.raises(InvalidMesh, match=message):
        Surface.from_polygons(TORUS.vertices, TORUS.corners, offsets)


def test_errors_have_one_base():
    assert issubclass(InvalidMesh, Error)
    assert issubclass(TopologyError, Error)
    assert issubclass(Error, Exception)


@pytest.mark.parametrize("faces", [3, [[0, 1, 2], None]])
def test_faces_that_are_no_lists_are_refused(faces):
    with pytest.raises(InvalidMesh, match="faces must be"):
        Surface(np.eye(3), faces)


@pytest.mark.parametrize("vertices", [np.eye(3) + 1j, np.ma.masked_array(np.eye(3), np.eye(3) > 0)])
def test_no_part_of_a_number_is_dropped(vertices):
    with pytest.raises(InvalidMesh, match="vertices has (complex|masked) entries"):
        Surface(vertices, [[0, 1, 2]])


def test_masked_faces_are_refused():
    with pytest.raises(InvalidMesh, match="faces has masked entries"):
        Surface(np.eye(3), np.ma.masked_array([[0, 1, 2]], [[False, False, True]]))
