"""Surface.read: every format, every way in which a file can be malformed, and the real files."""

import os
import re
import struct

import counting
import families
import numpy as np
import pytest
from holomorph import Error, InvalidMesh, Surface
from mesh_files import (
    HEXAGON,
    MIXED,
    POLYGON_FILES,
    TRIANGLE_FILES,
    TRIANGLES,
    VERTICES,
    obj,
    off,
    ply_binary,
    ply_text,
    stl_binary,
    stl_text,
)
from shared_data import REAL, by_component, real_file


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content)
    return path


@pytest.mark.parametrize("name", POLYGON_FILES)
def test_polygons_order_and_doubles_are_kept(name, tmp_path):
    surface = Surface.read(written(tmp_path, name, POLYGON_FILES[name]))
    assert (surface.vertices == MIXED.vertices).all()
    assert (surface.corner_vertices == MIXED.corners).all()
    assert (surface.face_offsets == MIXED.offsets).all()


@pytest.mark.parametrize("name", TRIANGLE_FILES)
def test_equal_corners_are_welded(name, tmp_path):
    surface = Surface.read(written(tmp_path, name, TRIANGLE_FILES[name]))
    assert (surface.vertices[surface.corner_vertices] == VERTICES[TRIANGLES.corners]).all()
    assert len(surface.vertices) == len(VERTICES)
    _, first = np.unique(surface.corner_vertices, return_index=True)
    assert (np.diff(first) > 0).all()  # numbered by first appearance
    assert surface.genus == 1


def test_negative_zero_is_zero_and_nothing_else_is_rounded(tmp_path):
    tiny = 5e-324  # the smallest positive double
    mesh = families.tetrahedron()
    text = stl_text(mesh).replace(b"0.0 1.0 0.0", b"-0.0 1.0 -0.0", 1)
    assert len(Surface.read(written(tmp_path, "a.stl", text)).vertices) == 4
    text = stl_text(mesh).replace(b"0.0 1.0 0.0", f"{tiny!r} 1.0 0.0".encode(), 1)
    surface = Surface.read(written(tmp_path, "b.stl", text), strict=True)
    assert len(surface.vertices) == 5
    assert tiny in surface.vertices


@pytest.mark.parametrize("name", ["a.obj", "a.off", "a.ply"])
def test_other_formats_are_not_welded(name, tmp_path):
    mesh = TRIANGLES
    soup = families.uniform(mesh.vertices[mesh.corners], np.arange(len(mesh.corners)).reshape(-1, 3))
    content = {"a.obj": obj, "a.off": off, "a.ply": ply_text}[name](soup)
    assert len(Surface.read(written(tmp_path, name, content), strict=True).components) == mesh.face_count


def test_triangle_strips(tmp_path):
    """An octahedron as a band of six triangles and two single ones: every other triangle of a strip is reversed."""
    points = np.concatenate([np.eye(3), -np.eye(3)]).astype(int)
    head = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    body = "".join("{} {} {}\n".format(*point) for point in points.tolist())
    strips = "16 0 5 1 3 2 4 0 5 -1 0 1 2 -1 3 5 4\n"
    surface = Surface.read(written(tmp_path, "strips.ply", (head + body + strips).encode()))
    band = [[0, 5, 1], [1, 5, 3], [1, 3, 2], [2, 3, 4], [2, 4, 0], [0, 4, 5]]
    assert surface.corner_vertices.reshape(-1, 3).tolist() == [*band, [0, 1, 2], [3, 5, 4]]
    assert surface.genus == 0
    assert not surface.repairs


def test_path_may_be_text(tmp_path):
    assert Surface.read(str(written(tmp_path, "ünïcode.off", off(MIXED)))).genus == 1


def test_path_may_be_any_bytes_that_a_file_system_takes(tmp_path):
    """Such names are str with surrogates in Python; the message has question marks instead."""
    name = os.fsencode(tmp_path / "caf") + b"\xe9.off"
    try:
        with open(name, "wb") as file:
            file.write(off(MIXED))
    except (OSError, UnicodeDecodeError):
        pytest.skip("this system takes only UTF-8")
    assert Surface.read(os.fsdecode(name)).genus == 1
    assert Surface.read(name).genus == 1
    with pytest.raises(InvalidMesh, match=r"caf\?2\.off: there is no such file"):
        Surface.read(os.fsdecode(name.replace(b"\xe9", b"\xe92")))


@pytest.mark.parametrize("path", [None, 3, ["a.obj"]])
def test_path_that_is_none(path):
    with pytest.raises(TypeError):
        Surface.read(path)


# ---- as other programs write them ----------------------------------------------------------------


@pytest.mark.parametrize(
    "head", ["OFF20 19 0", "OFF 20 19 0", "COFF20 19 0", "OFF20\t19 0\r", "# of an archive\nOFF20 19 0"]
)
def test_the_counts_of_an_off_file_follow_its_keyword(head, tmp_path):
    lines = off(MIXED).decode().splitlines()
    text = "\n".join([head, *lines[2:]])
    assert Surface.read(written(tmp_path, "glued.off", text.encode())).genus == 1


@pytest.mark.parametrize("word", ["-1.#IND", "1.#QNAN", "1.#SNAN00", "1.#INF", "-1.#INF000", "nan(ind)", "-nan", "inf"])
@pytest.mark.parametrize("kind", ["obj", "off", "ply", "stl"])
def test_what_is_no_number_costs_its_faces_alone(kind, word, tmp_path):
    text = {"obj": OBJ, "off": OFF, "ply": PLY, "stl": STL}[kind].decode()
    pattern = {"obj": r"(?m)^v \S+", "off": r"(?m)^\S+\.\S+", "ply": r"(?<=end_header\n)\S+", "stl": r"vertex \S+"}[
        kind
    ]
    new = {"obj": "v ", "stl": "vertex "}.get(kind, "") + word
    surface = Surface.read(written(tmp_path, f"odd.{kind}", re.sub(pattern, new, text, count=1).encode()))
    (refused,) = surface.refused
    assert ("infinite" if "inf" in word.lower() else "not a number") in refused.reason
    assert 0 < len(refused.faces) < 10


@pytest.mark.parametrize(("written_as", "value"), [("1D+2", 100), ("2.5d-1", 0.25), ("3E1", 30), ("7,", 7), ("+4.", 4)])
def test_numbers_as_fortran_and_tables_have_them(written_as, value, tmp_path):
    text = f"v {written_as} 0 0\nv 0,\t1, 0\nv 0 0 1\r\nf 1 2 3\n"
    assert Surface.read(written(tmp_path, "numbers.obj", text.encode())).vertices[0, 0] == value


def test_a_decimal_comma_is_told(tmp_path):
    with pytest.raises(InvalidMesh, match="line 1.*'1,5': numbers need decimal points"):
        Surface.read(written(tmp_path, "comma.obj", b"v 1,5 0 0\n"))


def test_a_comment_may_follow_a_number(tmp_path):
    text = b"v 1.0#one\nv 0 1 0 # two\nv 0 0 1\n".replace(b"1.0#one", b"1. 0 0#one") + b"f 1 2 3#face\n"
    assert Surface.read(written(tmp_path, "comments.obj", text)).vertices[0].tolist() == [1, 0, 0]


@pytest.mark.parametrize("name", ["Part", "_part", "-1", "", " part"])
def test_the_name_of_a_solid_may_follow_at_once(name, tmp_path):
    text = stl_text(TRIANGLES).decode().splitlines()
    text = [f"solid{name}", *text[1:-1], f"endsolid{name}"]
    surface = Surface.read(written(tmp_path, "named.stl", "\n".join(text).encode()))
    assert surface.genus == 1 and not surface.repairs.notes


# ---- malformed files -----------------------------------------------------------------------------


OBJ, OFF, PLY, BINARY, STL = obj(MIXED), off(MIXED), ply_text(MIXED), ply_binary(MIXED), stl_text(TRIANGLES)
MALFORMED = {
    "word.obj": (OBJ.replace(b"v ", b"v x", 1), r"line 3.*'x"),
    "comma.obj": (OBJ.replace(b".", b",", 1), r"line 3"),
    "two coordinates.obj": (b"v 1 2\n" + OBJ, r"line 1.*three coordinates"),
    "vertex zero.obj": (OBJ + b"f 0 1 2\n", r"vertex 0"),
    "too far back.obj": (b"v 0 0 0\nf -1 -2 -3\n", r"line 2.*-2.*1 vert"),
    "real index.obj": (OBJ + b"f 1 2 3.5\n", r"'3.5'"),
    "enormous index.obj": (OBJ + b"f 1 2 99999999999999999999\n", r"'9999"),
    "index out of range.obj": (OBJ + b"f 1 2 21\n", r"face 20 .*vertex 21.*from 1 "),
    "two corners.obj": (OBJ + b"f 1 2\n", r"face 20 .*2 corners"),
    "not a number.obj": (OBJ.replace(b"v ", b"v nan 0 0\nv ", 1), r"vertex 1 "),
    "not text.obj": (b"v 0 0 0\n\0\0v 1 0 0\n", r"text"),
    "no faces.obj": (b"v 0 0 0\n", r"no faces"),
    "empty.obj": (b"", r"no faces"),
    "empty.off": (b"", r"empty"),
    "comment only.off": (b"# nothing\n", r"empty"),
    "other keyword.off": (b"PLY\n" + OFF, r"line 1.*OFF"),
    "four dimensions.off": (OFF.replace(b"OFF", b"4OFF"), r"4OFF"),
    "binary.off": (OFF.replace(b"OFF", b"OFF BINARY"), r"binary"),
    "counts missing.off": (b"OFF\n", r"number of vertices"),
    "negative count.off": (OFF.replace(b"20 ", b"-20 ", 1), r"line 2.*-20"),
    "absurd vertex count.off": (OFF.replace(b"20 ", b"99999999999 ", 1), r"line 2.*99999999999"),
    "absurd face count.off": (OFF.replace(b"20 19", b"20 99999999999", 1), r"line 2.*99999999999"),
    "absurd corner count.off": (OFF.replace(b"\n6 ", b"\n999999999 ", 1), r"line 41.*999999999"),
    "negative corner count.off": (OFF.replace(b"\n6 ", b"\n-6 ", 1), r"line 41.*-6"),
    "vertices missing.off": (OFF.replace(b"20 19", b"400 19"), r"vertex|three|more than"),
    "face missing.off": (OFF[: OFF.rindex(b"\n6 ")], r"face 18 of 19"),
    "face too much.off": (OFF + b"3 0 1 2\n", r"line 42.*19 faces"),
    "cut.off": (OFF[:-4], r"line 4\d"),
    "no ply.ply": (b"plx" + PLY[3:], r"'ply'"),
    "header cut.ply": (PLY[:150], r"header"),
    "no format.ply": (PLY.replace(b"format ascii 1.0\n", b""), r"format"),
    "other format.ply": (PLY.replace(b"ascii", b"zip"), r"line 2.*'zip'"),
    "other type.ply": (PLY.replace(b"double", b"quad", 1), r"line 5.*'quad'"),
    "other line.ply": (PLY.replace(b"comment", b"remark"), r"line 3.*'remark'"),
    "property first.ply": (b"ply\nformat ascii 1.0\nproperty int x\nend_header\n", r"line 3"),
    "bad property.ply": (PLY.replace(b"property double y", b"property double"), r"line 7"),
    "bad element.ply": (PLY.replace(b"element vertex 20", b"element vertex"), r"line 4"),
    "word count.ply": (PLY.replace(b"element vertex 20", b"element vertex many"), r"line 4.*'many'"),
    "negative count.ply": (PLY.replace(b"element vertex 20", b"element vertex -2"), r"line 4.*-2"),
    "absurd count.ply": (PLY.replace(b"element vertex 20", b"element vertex 88888888888"), r"88888888888"),
    "absurd binary count.ply": (BINARY.replace(b"element vertex 20", b"element vertex 88888888888"), r"88888888888"),
    "real list count.ply": (PLY.replace(b"list uchar int", b"list float int"), r"line 14.*integer"),
    "no z.ply": (PLY.replace(b"property double z", b"property double w"), r"'z'"),
    "no list.ply": (PLY.replace(b"vertex_indices", b"corners"), r"vertex_indices"),
    "vertices twice.ply": (PLY.replace(b"element edge 1", b"element vertex 1"), r"vertex"),
    "value missing.ply": (PLY.replace(b" 255 ", b" ", 1), r"line 17"),
    "value too much.ply": (PLY.replace(b" 255 ", b" 255 0 ", 1), r"line 17"),
    "word value.ply": (re.sub(rb"(?<=end_header\n)\S+", b"red", PLY), r"line 17.*'red'"),
    "real index.ply": (PLY.replace(b"0.5\n", b"0.5\n", 1).replace(b"\n4 1 ", b"\n4 1.5 ", 1), r"'1.5'"),
    "row missing.ply": (PLY[: PLY.rindex(b"\n6 ") + 1], r"row 18"),
    "row too much.ply": (PLY + b"3 0 1 2 0.5\n", r"last element"),
    "cut.ply": (BINARY[:-3], r"element 'face' 18"),
    "cut vertex.ply": (BINARY[: BINARY.index(b"end_header") + 60], r"more than the file|element 'vertex'"),
    "negative list.ply": (
        ply_binary(MIXED, count="int8").replace(struct.pack("<b6i", 6, *HEXAGON), struct.pack("<b6i", -6, *HEXAGON)),
        r"element 'face' 18.*-6",
    ),
    "absurd list.ply": (
        ply_binary(MIXED, count="int").replace(struct.pack("<7i", 6, *HEXAGON), struct.pack("<7i", 2**30, *HEXAGON)),
        r"element 'face' 18.*1073741824",
    ),
    "fraction.ply": (
        ply_binary(MIXED, index="float").replace(struct.pack("<6f", *HEXAGON), struct.pack("<6f", 0.5, *HEXAGON[1:])),
        r"element 'face' 18.*0.5",
    ),
    "empty.ply": (b"", r"ply"),
    "empty.stl": (b"", r"STL"),
    "short.stl": (b"nothing", r"STL"),
    "no facet.stl": (b"solid x\nendsolid x\n", r"no faces"),
    "cut.stl": (STL[: STL.rindex(b"vertex") + 12], r"line \d+"),
    "two corners.stl": (re.sub(rb" *vertex .*\n", b"", STL, count=1), r"line 6.*'vertex'.*'endloop'"),
    "four corners.stl": (STL.replace(b"  endloop", b"vertex 0 0 0\n  endloop", 1), r"line 7.*'endloop'"),
    "word.stl": (STL.replace(b"vertex ", b"vertex x", 1), r"line 4.*'x"),
    "other word.stl": (STL.replace(b"facet", b"fact", 1), r"line 2.*'fact'"),
    "cut binary.stl": (stl_binary(TRIANGLES)[:-10], r"40 triangles.*39"),
    "absurd.stl": (b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 70, r"4294967295"),
    "mesh.xyz": (b"", r"\.obj, \.off, \.ply"),
    "mesh": (b"", r"\.obj, \.off, \.ply"),
}


# What is wrong with single faces: the others are read.
OF_FACES = ("index out of range.obj", "two corners.obj", "not a number.obj")


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_file_is_refused_and_named(name, tmp_path):
    content, message = MALFORMED[name]
    for strict in {True, name in OF_FACES}:
        with pytest.raises(InvalidMesh, match=message) as caught:
            Surface.read(written(tmp_path, name, content), strict=strict)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", OF_FACES)
def test_faces_that_cannot_be_mapped_are_named(name, tmp_path):
    content, message = MALFORMED[name]
    (refused,) = Surface.read(written(tmp_path, name, content)).refused
    assert re.search(message, refused.reason)


def test_file_name_is_in_the_message(tmp_path):
    with pytest.raises(InvalidMesh, match=r"bad\.obj, line 1: "):
        Surface.read(written(tmp_path, "bad.obj", b"v 1 x 2\n"))


def test_missing_file(tmp_path):
    with pytest.raises(InvalidMesh, match=r"absent\.obj.*no such file"):
        Surface.read(tmp_path / "absent.obj")


def test_folder(tmp_path):
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(InvalidMesh, match="directory"):
        Surface.read(tmp_path / "folder.obj")


WHOLE = {"a.obj": OBJ, "a.off": OFF, "a.ply": PLY, "b.ply": BINARY, "a.stl": STL, "b.stl": stl_binary(TRIANGLES)}


@pytest.mark.parametrize("name", WHOLE)
def test_any_truncation_and_any_wrong_byte_reads_or_is_refused(name, tmp_path):
    """Never anything but a surface or one of our errors: 400 damaged copies of each file, always the same ones."""
    random = np.random.default_rng(11)
    path = tmp_path / name
    for _ in range(400):
        damaged = bytearray(WHOLE[name])
        if random.random() < 0.5:
            del damaged[random.integers(len(damaged)) :]
        for place in random.integers(max(len(damaged), 1), size=3 if damaged else 0):
            damaged[place] = random.integers(256)
        path.write_bytes(damaged)
        try:
            Surface.read(path)
        except Error as error:
            assert str(error)


# ---- real files ----------------------------------------------------------------------------------


@pytest.mark.skipif(not REAL, reason="no folder ../shared/meshes")
@pytest.mark.parametrize("name", REAL or [None])
def test_real_mesh_is_read_like_its_row_says(name, tmp_path):
    vertices, sizes, topology, flags = REAL[name]
    invalid = any(flag in flags for flag in ("nm edges", "nm vertices", "duplicate faces"))
    path = real_file(name, tmp_path)
    if invalid or "N" in topology:
        with pytest.raises(Error):
            Surface.read(path, strict=True)
        return
    whole, surface = Surface.read(path), Surface.read(path, strict=True)
    assert not whole.refused and (whole.is_whole or len(whole.repairs.joined_vertices))
    assert len(surface.vertices) == int(vertices)
    count = {int(size): int(number) for size, number in (entry.split(":") for entry in sizes.split(","))}
    found = np.unique(np.diff(surface.face_offsets), return_counts=True)
    assert (
        dict(zip(*(part.tolist()[:3] for part in found), strict=True)) == count
    )  # the table has the three smallest sizes
    isolated = re.search(r"isolated (\d+)", flags)
    assert len(surface.repairs.isolated_vertices) == (int(isolated[1]) if isolated else 0)
    parts = sorted((part.genus, part.boundary_count) for part in surface.components)
    assert parts == sorted(
        counting.topology(families.Mesh(surface.vertices, surface.corner_vertices, surface.face_offsets))
    )
    if by_component(topology):
        assert parts == by_component(topology)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "mesh.obj")
    with pytest.raises(InvalidMesh, match="pipe"):
        Surface.read(tmp_path / "mesh.obj")
