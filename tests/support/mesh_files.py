"""Small meshes as files of every format that is read."""

import re
import struct

import families
import numpy as np

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


def write_obj(path, mesh):
    path.write_bytes(obj(mesh))
    return path
