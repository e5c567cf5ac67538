"""Files as other programs write them, not as their formats ask: read whole, or refused in a sentence that is true."""

import re
import struct
from dataclasses import replace

import numpy as np
import pytest
from holomorph import InvalidMesh, Surface
from mesh_files import MIXED, TRIANGLES, VERTICES, obj, off, ply_binary, ply_text, stl_binary, stl_text

STL, BINARY, OBJ, OFF = stl_text(TRIANGLES), stl_binary(TRIANGLES), obj(MIXED), off(MIXED)
PLY, PLY_TEXT = ply_binary(MIXED), ply_text(MIXED)
COUNT = TRIANGLES.face_count
FACET = stl_text(TRIANGLES).split(b"facet", 2)[1]
CUT_OFF, NESTED, AFTER = "may have been cut off", "before the one before it has ended", "text after 'endsolid'"


def counted(number, content=BINARY):
    """A binary STL that announces another number of triangles."""
    return content[:80] + struct.pack("<I", number) + content[84:]


def with_attributes(size, content=BINARY):
    """Every triangle followed by as many bytes as its attribute tells, as the format says and nobody reads."""
    body = content[84:]
    rows = [body[k : k + 48] + struct.pack("<H", size) + bytes(range(1, size + 1)) for k in range(0, len(body), 50)]
    return content[:84] + b"".join(rows)


def ended(content, newline, binary=True):
    """A PLY file whose header's lines end so."""
    head, body = content.split(b"end_header\n", 1)
    text = (head + b"end_header\n").replace(b"\n", newline)
    return text + (body if binary else body.replace(b"\n", newline))


def starting_with(byte, newline):
    """A binary PLY in which the first byte after the header is a part of a newline: x of the first vertex is moved."""
    moved = VERTICES.copy()
    moved[0, 0] = struct.unpack("<d", bytes([byte]) + struct.pack("<d", VERTICES[0, 0])[1:])[0]
    return ended(ply_binary(replace(MIXED, vertices=moved)), newline)


SOLIDS = STL.replace(b"endfacet\n", b"endfacet\nendsolid x\nsolid y\n", 3)
UNENDED = re.sub(rb"endsolid.*\n", b"", SOLIDS)
TRIANGLE_FILES = {
    "end solid.stl": (STL.replace(b"endsolid", b"end solid"), ""),
    "End Solid with a name.stl": (STL.replace(b"endsolid", b"End Solid part 7"), ""),
    "end loop.stl": (STL.replace(b"endloop", b"end loop"), ""),
    "end_loop.stl": (STL.replace(b"endloop", b"end_loop").replace(b"endfacet", b"end_facet"), ""),
    "EndLoop, EndFacet.stl": (STL.replace(b"endloop", b"EndLoop").replace(b"endfacet", b"End  Facet"), ""),
    "outerloop.stl": (STL.replace(b"outer loop", b"outerloop"), ""),
    "tabs.stl": (STL.replace(b"  ", b"\t").replace(b"vertex ", b"vertex\t"), ""),
    "marked.stl": (b"\xef\xbb\xbf" + STL, ""),
    "marked, blanks.stl": (b"\xef\xbb\xbf \r\n" + STL.replace(b"\n", b"\r\n"), ""),
    "zero at the end.stl": (STL + b"\0", ""),
    "padded with zeros.stl": (STL + bytes(512 - len(STL) % 512), ""),
    "Ctrl-Z.stl": (STL + b"\x1a", ""),
    "Ctrl-Z and lines.stl": (STL + b"\r\n\x1a\r\n", ""),
    "zeros in the name.stl": (STL.replace(b"solid with a name", b"solid name\0\0\0\0"), ""),
    "no newline at the end.stl": (STL.rstrip(b"\n"), ""),
    "several solids.stl": (SOLIDS, ""),
    "several solids, none ended.stl": (UNENDED, f"{NESTED}.*{CUT_OFF}"),
    "one solid, not ended.stl": (STL.replace(b"endsolid\n", b""), CUT_OFF),
    "several solids, the last ended.stl": (re.sub(rb"endsolid x\n", b"", SOLIDS), NESTED),
    "text after the triangles.stl": (STL + b"exported by a program\nsecond line\n", AFTER),
    "text between solids.stl": (SOLIDS.replace(b"endsolid x\n", b"endsolid x\n; a comment\n", 1), AFTER),
    "no count.stl": (counted(0), f"announces 0 triangles, but has {COUNT}"),
    "count of a stream.stl": (counted(2**32 - 1), f"announces {2**32 - 1} triangles, but has {COUNT}"),
    "count too small.stl": (counted(COUNT - 30), f"announces {COUNT - 30} triangles, but has {COUNT}"),
    "count too large.stl": (counted(COUNT + 9), f"announces {COUNT + 9} triangles, but has {COUNT}"),
    "text after a binary one.stl": (BINARY + b"made by a program of long standing, in millimetres, on a Tuesday\n", ""),
    "as long as a triangle.stl": (BINARY + b"x" * 50, ""),
    "blocks of a tape.stl": (BINARY + bytes(700), ""),
    "blanks after.stl": (BINARY + b" " * 333, ""),
    "colours as attributes.stl": (BINARY[:132] + b"\x1f\x7c" + BINARY[134:], ""),
    "solid as its comment.stl": (b"solid made by a program".ljust(80) + BINARY[80:], ""),
    "solid as its comment, no count.stl": (counted(0, b"solid x".ljust(80) + BINARY[80:]), "announces 0 triangles"),
}
POLYGON_FILES = {
    "cr.ply": (ended(PLY, b"\r"), ""),
    "lf cr.ply": (ended(PLY, b"\n\r"), ""),
    "cr lf.ply": (ended(PLY, b"\r\n"), ""),
    "cr as text.ply": (ended(PLY_TEXT, b"\r", binary=False), ""),
    "lf cr as text.ply": (ended(PLY_TEXT, b"\n\r", binary=False), ""),
    "cr lf above lf.ply": (PLY.replace(b"\n", b"\r\n", 1), ""),
    "marked.ply": (b"\xef\xbb\xbf" + PLY_TEXT, ""),
    "blanks at line ends.ply": (PLY.replace(b"1.0\n", b"1.0  \n", 1).replace(b"end_header\n", b"end_header \n"), ""),
    "Ctrl-Z.ply": (PLY_TEXT + b"\x1a", ""),
    "zeros at the end.ply": (PLY + bytes(9), ""),
    "blanks after a continuation.obj": (re.sub(rb"(?m)^f (\d+) (\d+) ", rb"f \1 \\ \t\n \2 \\  \r\n ", OBJ), ""),
    "continuation at the end.obj": (OBJ.rstrip(b"\n") + b" \\ ", ""),
    "continued at once.obj": (re.sub(rb"(?m)^f (\d+) (\d+) ", rb"f \1\\ \n\2 ", OBJ), ""),
    "comments at line ends.obj": (re.sub(rb"(?m)^([vf] .*)$", rb"\1 # of a part", OBJ), ""),
    "comments that touch.obj": (re.sub(rb"(?m)^([vf] .*)$", rb"\1#1 2 3", OBJ), ""),
    "tabs and indents.obj": (re.sub(rb"(?m)^([vf]) ", rb"\t  \1\t", OBJ), ""),
    "marked.obj": (b"\xef\xbb\xbf\r\n" + OBJ, ""),
    "zero at the end.obj": (OBJ + b"\0\0", ""),
    "Ctrl-Z.obj": (OBJ + b"\x1a\n", ""),
    "a path that ends with a backslash.obj": (b"mtllib C:\\parts\\\n" + OBJ, ""),
    "colours.obj": (obj(MIXED, vertex="v {!r} {!r} {!r} 1.0 0.5 0.5"), "colours"),
    "zero at the end.off": (OFF + b"\0", ""),
    "marked, Ctrl-Z.off": (b"\xef\xbb\xbf" + OFF + b"\x1a", ""),
    "comments that touch.off": (OFF.replace(b"\n", b"#\n"), ""),
}
REFUSED = {
    "attributes.stl": (with_attributes(2), f"attributes of {2 * COUNT} bytes"),
    "attributes as long as triangles.stl": (with_attributes(50), f"attributes of {50 * COUNT} bytes"),
    "attributes of one triangle.stl": (with_attributes(7, counted(1, BINARY[:134])), "attributes of 7 bytes"),
    "cut off.stl": (BINARY[:-20], f"announces {COUNT} triangles, but ends after {COUNT - 1}"),
    "bytes after.stl": (BINARY + bytes(range(1, 64)), "goes on after them with 63 bytes"),
    "no solid.stl": (STL.split(b"\n", 1)[1], "'solid' is expected, but found 'facet'"),
    "facet after the end.stl": (STL + b"facet" + FACET, "'solid' is expected, but found 'facet'"),
    "quads.stl": (STL.replace(b"  endloop", b"vertex 0 0 0\nendloop"), "'endloop' is expected, but found 'vertex'"),
    "utf-16.stl": (STL.decode().encode("utf-16"), "UTF-16"),
    "cut off in the header.ply": (ended(PLY, b"\r")[:40], "ends inside the PLY header"),
    "zeros inside.obj": (OBJ.replace(b"v ", b"\0v ", 1), "zero bytes"),
    "utf-16.obj": (OBJ.decode().encode("utf-16"), "UTF-16"),
}


def read(folder, name, content):
    path = folder / name
    path.write_bytes(content)
    return Surface.read(path)


def told(surface):
    return " ".join(surface.repairs.notes)


def assert_notes(surface, note):
    assert re.search(note, told(surface)) if note else not surface.repairs.notes


@pytest.mark.parametrize("name", TRIANGLE_FILES)
def test_all_triangles_are_read(name, tmp_path):
    content, note = TRIANGLE_FILES[name]
    surface = read(tmp_path, name, content)
    assert (surface.vertices[surface.corner_vertices] == VERTICES[TRIANGLES.corners]).all()
    assert_notes(surface, note)


@pytest.mark.parametrize("name", POLYGON_FILES)
def test_all_polygons_are_read(name, tmp_path):
    content, note = POLYGON_FILES[name]
    surface, coloured = read(tmp_path, name, content), "colours" if name.endswith(".ply") else ""
    assert (surface.vertices == MIXED.vertices).all()
    assert (surface.corner_vertices == MIXED.corners).all()
    assert (surface.face_offsets == MIXED.offsets).all()
    assert_notes(surface, note or coloured)


@pytest.mark.parametrize("name", REFUSED)
def test_the_rest_is_refused(name, tmp_path):
    content, message = REFUSED[name]
    with pytest.raises(InvalidMesh, match=message) as caught:
        read(tmp_path, name, content)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("newline", [b"\r", b"\n", b"\r\n", b"\n\r"])
@pytest.mark.parametrize("byte", [0x0A, 0x0D])
def test_the_first_byte_after_a_header_is_never_a_part_of_it(newline, byte, tmp_path):
    surface = read(tmp_path, "a.ply", starting_with(byte, newline))
    assert (surface.vertices[1:] == MIXED.vertices[1:]).all()
    assert abs(surface.vertices[0] - MIXED.vertices[0]).max() < 1e-12


def test_elements_that_no_header_announces_are_told(tmp_path):
    content = PLY.replace(b"element face 19", b"element face 17")
    surface = read(tmp_path, "a.ply", content)
    assert len(surface.face_offsets) - 1 == MIXED.face_count - 2
    assert re.search(r"has \d+ bytes after the last element", told(surface))


def test_the_coloured_ones_say_what_is_not_kept(tmp_path):
    assert "colours" in told(read(tmp_path, "a.ply", ply_text(MIXED)))
    coloured = off(MIXED, head="COFF\n{} {} 0\n", vertex="{!r} {!r} {!r} 255 0 0 255")
    assert "colours" in told(read(tmp_path, "a.off", coloured))


MAPPED = {
    "own.ply": None,
    "of vertices.ply": PLY_TEXT.replace(b"uchar red", b"uchar texture_u"),
    "of faces.ply": PLY_TEXT.replace(b"float weight", b"list uchar float texcoord").replace(b" 0.5\n", b" 2 0.5 0.5\n"),
    "of vertices.off": off(MIXED, head="STOFF\n{} {} 0\n", vertex="{!r} {!r} {!r} 0.5 0.5"),
}


@pytest.mark.parametrize("name", MAPPED)
def test_a_map_is_not_kept_and_that_is_told(name, tmp_path):
    content = MAPPED[name]
    if content is None:
        whole = read(tmp_path, "a.obj", OBJ)
        whole.write(tmp_path / name, np.zeros((len(whole.corner_vertices), 2)))
        content = (tmp_path / name).read_bytes()
    assert "its UVs are not read" in told(read(tmp_path, name, content))


def test_faces_and_vertices_have_the_numbers_of_the_file(tmp_path):
    """OBJ counts from 1; an STL file has triangles without extent, which are left out before those after them."""
    surface = read(tmp_path, "a.obj", OBJ + b"f 1 2 99\n")
    (refused,) = surface.refused
    assert f"face {MIXED.face_count + 1} names vertex 99; numbers from 1" in refused.reason
    assert refused.faces.tolist() == [MIXED.face_count]
    vertex = read(tmp_path, "b.obj", OBJ + b"v nan 0 0\nf 1 2 21\n").refused[0]
    assert "vertex 21 has a coordinate that is not a number" in vertex.reason
    point = struct.pack("<12fH", 0, 0, 1, *[1.0, 2.0, 3.0] * 3, 0)
    wild = struct.pack("<12fH", 0, 0, 1, np.nan, *range(8), 0)
    body = BINARY[84:]
    mixed = counted(COUNT + 3, BINARY[:84] + point + body[:100] + point + body[100:] + wild)
    surface = read(tmp_path, "c.stl", mixed)
    assert surface.face_index.tolist() == [1, 2, *range(4, COUNT + 2)]
    assert surface.corner_index.tolist() == [3 * face + k for face in surface.face_index for k in range(3)]
    assert surface.refused[0].faces.tolist() == [COUNT + 2]
    with pytest.raises(InvalidMesh, match="the edge between vertices 1 and 2 has 3 faces"):
        (tmp_path / "d.obj").write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n")
        Surface.read(tmp_path / "d.obj", strict=True)
