"""Surface.read: every format, every way in which a file can be malformed, and the real files."""

import gzip
import os
import re
import struct

import counting
import families
import numpy as np
import pytest
from conftest import SHARED, shared_folder
from holomorph import Error, InvalidMesh, Surface

# A torus of quads, one of them cut into triangles and two of them joined to a hexagon: all sizes of polygons.
QUADS = families.grid_quads(5, 4)
VERTICES = families.torus(5, 4).vertices.astype(np.float32).astype(float)  # also exact in files of float32
HEXAGON = [0, 4, 8, 9, 5, 1]
MIXED = families.polygons(VERTICES, [*QUADS[1:4].tolist(), *QUADS[5:].tolist(), HEXAGON], ((1, 0),))
TRIANGLES = families.uniform(VERTICES, families.cut_quads(QUADS), ((1, 0),))


def rows(mesh, vertex="{!r} {!r} {!r}", face="{size} {list}", first=0):
    """The vertices and the faces of a text file."""
    points = [vertex.format(*point) for point in mesh.vertices.tolist()]
    faces = [face.format(size=len(f), list=" ".join(str(v + first) for v in f.tolist())) for f in mesh.faces]
    return points, faces


def obj(mesh, newline="\n", **formats):
    points, faces = rows(mesh, **{"vertex": "v {!r} {!r} {!r}", "face": "f {list}", "first": 1} | formats)
    return (newline.join(["# a comment", "o part", *points, "s off", *faces]) + newline).encode()


def off(mesh, head="OFF\n{} {} 0\n", **formats):
    points, faces = rows(mesh, **formats)
    return (head.format(len(points), len(faces)) + "\n".join([*points, *faces]) + "\n").encode()


PLY_HEAD = """ply
format {} 1.0
comment a comment
element vertex {}
property {real} x
property uchar red
property {real} y
property {real} z
property list uchar short extra
element edge 1
property int vertex1
property int vertex2
element face {}
property list {count} {index} vertex_indices
property float weight
end_header
"""


def ply_text(mesh):
    points, faces = rows(mesh, vertex="{!r} 255 {!r} {!r} 2 7 -8", face="{size} {list} 0.5")
    head = PLY_HEAD.format("ascii", len(points), len(faces), real="double", count="uchar", index="int")
    return (head + "\n".join([*points, "0 1", *faces]) + "\n").encode()


CODES = {"uchar": "B", "int8": "b", "short": "h", "ushort": "H", "int": "i", "uint32": "I", "float": "f", "double": "d"}


def ply_binary(mesh, order="<", real="double", count="uchar", index="int"):
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = PLY_HEAD.format(name, len(mesh.vertices), mesh.face_count, real=real, count=count, index=index)
    point = struct.Struct(order + CODES[real] + "B" + 2 * CODES[real] + "B2h")
    body = [point.pack(x, 255, y, z, 2, 7, -8) for x, y, z in mesh.vertices.tolist()]
    body.append(struct.pack(order + "2i", 0, 1))
    body += [struct.pack(f"{order}{CODES[count]}{len(f)}{CODES[index]}f", len(f), *f.tolist(), 0.5) for f in mesh.faces]
    return head.encode() + b"".join(body)


def stl_text(mesh, case=str.lower):
    text = "solid with a name\n"
    for face in mesh.faces:
        text += case("facet normal 0 0 1\n  outer loop\n")
        text += "".join("    vertex {!r} {!r} {!r}\n".format(*mesh.vertices[v].tolist()) for v in face)
        text += case("  endloop\nendfacet\n")
    return (text + "endsolid\n").encode()


def stl_binary(mesh, head=b"made by a test", tail=b""):
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *mesh.vertices[face].ravel().tolist(), 0) for face in mesh.faces)
    return head.ljust(80, b"\0") + struct.pack("<I", mesh.face_count) + body + tail


POLYGON_FILES = {
    "plain.obj": obj(MIXED),
    "UPPER.OBJ": obj(MIXED),
    "windows.obj": obj(MIXED, newline="\r\n"),
    "mac.obj": obj(MIXED, newline="\r"),
    "marked.obj": b"\xef\xbb\xbf" + obj(MIXED),
    "weights and colours.obj": obj(MIXED, vertex="v  {!r}\t{!r} {!r} 1.0 0.5 0.5 0.5 # red"),
    "plus signs.obj": re.sub(rb"(?<= )(?=\d+\.)", b"+", obj(MIXED)),
    "continued.obj": re.sub(rb"(?m)^f (\d+) (\d+) ", rb"f \1 \\\n \2\\\r\n ", obj(MIXED)),
    "textured.obj": b"vt 0 0\nvn 0 0 1\n" + re.sub(rb"(?m)(?<= )(\d+)(?= |$)", rb"\1/1/1", obj(MIXED)),
    "normals.obj": b"vn 0 0 1\n" + re.sub(rb"(?m)(?<= )(\d+)(?= |$)", rb"\1//1", obj(MIXED)),
    "from the end.obj": obj(MIXED, first=-len(VERTICES)),
    "unknown lines.obj": b"mtllib a.mtl\nusemtl b\ng c d\nl 1 2\np 1\n" + obj(MIXED),
    "plain.off": off(MIXED),
    "no edge count.off": off(MIXED, head="OFF\n{} {}\n"),
    "one line.off": off(MIXED, head="OFF {} {} 0\n"),
    "no keyword.off": off(MIXED, head="{} {} 0\n"),
    "commented.off": off(MIXED, head="# before\nOFF # here\n\n# there\n{} {} 0 # and here\n\n"),
    "coloured faces.off": off(MIXED, face="{size} {list} 255 0 0 255"),
    "coloured vertices.off": off(MIXED, head="COFF\n{} {} 0\n", vertex="{!r} {!r} {!r} 255 0 0 255"),
    "normals.off": off(MIXED, head="NOFF\n{} {} 0\n", vertex="{!r} {!r} {!r} 0 0 1"),
    "everything.off": off(MIXED, head="STCNOFF\n{} {} 0\n", vertex="{!r} {!r} {!r} 0 0 1 255 0 0 255 0.5 0.5"),
    "broken lines.off": off(MIXED, face="{size}\n{list}").replace(b" 8 9 ", b"\n8\n9 # corner\n"),
    "windows.off": off(MIXED).replace(b"\n", b"\r\n"),
    "text.ply": ply_text(MIXED),
    "windows.ply": ply_text(MIXED).replace(b"\n", b"\r\n"),
    "vertex_index.ply": ply_text(MIXED).replace(b"vertex_indices", b"vertex_index"),
    "little.ply": ply_binary(MIXED),
    "big.ply": ply_binary(MIXED, order=">"),
    "short.ply": ply_binary(MIXED, count="int8", index="short"),
    "unsigned.ply": ply_binary(MIXED, ">", "float", "ushort", "uint32"),
    "real indices.ply": ply_binary(MIXED, index="float"),
    "windows header.ply": ply_binary(MIXED).replace(b"\n", b"\r\n", PLY_HEAD.count("\n")),
    "padded.ply": ply_binary(MIXED) + b"\n",
}
TRIANGLE_FILES = {
    "text.stl": stl_text(TRIANGLES),
    "capitals.stl": stl_text(TRIANGLES, case=str.upper),
    "several solids.stl": stl_text(TRIANGLES).replace(b"endfacet\n", b"endfacet\nendsolid x\nsolid y\n", 3),
    "binary.stl": stl_binary(TRIANGLES),
    "binary that says solid.stl": stl_binary(TRIANGLES, head=b"solid facet"),
    "padded.stl": stl_binary(TRIANGLES, tail=b"\0\0"),
}


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
    surface = Surface.read(written(tmp_path, "b.stl", text))
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
    "index out of range.obj": (OBJ + b"f 1 2 21\n", r"face 19 .*20"),
    "two corners.obj": (OBJ + b"f 1 2\n", r"face 19 .*2 corners"),
    "not a number.obj": (OBJ.replace(b"v ", b"v nan 0 0\nv ", 1), r"vertex 0 "),
    "not text.obj": (b"v 0 0 0\n\0\0", r"text"),
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
    "not closed.stl": (STL[: STL.rindex(b"endsolid")], r"endsolid"),
    "cut.stl": (STL[: STL.rindex(b"vertex") + 12], r"line \d+"),
    "two corners.stl": (re.sub(rb" *vertex .*\n", b"", STL, count=1), r"line 6.*'vertex'.*'endloop'"),
    "four corners.stl": (STL.replace(b"  endloop", b"vertex 0 0 0\n  endloop", 1), r"line 7.*'endloop'"),
    "word.stl": (STL.replace(b"vertex ", b"vertex x", 1), r"line 4.*'x"),
    "other word.stl": (STL.replace(b"facet", b"fact", 1), r"line 2.*'fact'"),
    "cut binary.stl": (stl_binary(TRIANGLES)[:-10], r"40 triangles.*39"),
    "absurd.stl": (b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 50, r"4294967295"),
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


def table_of_real_meshes():
    """Rows of the table in the README of ../shared/meshes: file, #V, face sizes, topology, flags."""
    readme = SHARED / "meshes" / "README.md"
    if not readme.is_file():
        return {}
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in readme.read_text().splitlines()]
    return {row[0]: row[1:5] for row in cells if len(row) == 8 and re.fullmatch(r"\d+", row[1])}


REAL = table_of_real_meshes()


def real_file(name, folder):
    """The file itself, or an unpacked copy of it."""
    path = shared_folder("meshes") / name
    if path.suffix != ".gz":
        return path
    return written(folder, path.stem, gzip.decompress(path.read_bytes()))


def by_component(text):
    """'0b11 + 1' as {(0, 11): 1, (1, 0): 1}; None where the README leaves some out or a component is one-sided."""
    if "..." in text or "N" in text:
        return None
    parts = [part.strip().split("b") for part in text.split("+")]
    return sorted((int(part[0]), int(part[1]) if len(part) > 1 else 0) for part in parts)


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
