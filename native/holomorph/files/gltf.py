"""glTF 2.0, read as pieces, and written in its binary form: positions, UVs, and a texture that repeats."""

import base64
import json
import struct
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from .._native import InvalidMesh
from ..core import arrays
from . import whole_file

MAGIC, VERSION = 0x46546C67, 2
JSON, BINARY = 0x4E4F534A, 0x004E4942  # kinds of chunks
ALIGNMENT = 4  # bytes
VERTICES, INDICES = 34962, 34963  # what a part of the buffer is for
FLOAT, UNSIGNED = 5126, 5125
SAMPLER = {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}  # smooth at any distance, repeating
ROUGHNESS = 0.8
UP = "Y"
NAME = "glTF"
INSTANCES = "EXT_mesh_gpu_instancing"
NUMBERS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
MOST_ROWS = 50_000_000  # of an accessor that need not be in the file
TRIANGLES, STRIP, FAN = 4, 5, 6  # ways to draw; others draw points and lines


def encoded(points, triangles, uv=None, image=None):
    """The bytes of a GLB file, the same for the same mesh. Numbers are in single precision, of points far from the
    origin relative to a node there.

    points : (#P, 3); triangles : (#T, 3); uv : (#P, 2), with v upwards; image : a `textures.Image` on the mesh
    """
    buffer, attributes = _Buffer(), {}
    points, place = arrays.near_origin(points)
    attributes["POSITION"] = buffer.add_array(points.astype("<f4"), VERTICES, FLOAT, with_bounds=True)
    if uv is not None:
        downwards = uv * [1, -1] + [0, 1]  # as glTF counts v: from the top of the image
        attributes["TEXCOORD_0"] = buffer.add_array(downwards.astype("<f4"), VERTICES, FLOAT)
    indices = buffer.add_array(triangles.astype("<u4").reshape(-1, 1), INDICES, UNSIGNED)
    surface = {"metallicFactor": 0, "roughnessFactor": ROUGHNESS}
    content = {
        "asset": {"version": "2.0", "generator": "Holomorph"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0} | ({"translation": place.tolist()} if place.any() else {})],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": surface, "doubleSided": True}],
    }
    if image is not None:
        surface["baseColorTexture"] = {"index": 0}
        content["textures"] = [{"sampler": 0, "source": 0}]
        content["samplers"] = [SAMPLER]
        content["images"] = [{"bufferView": buffer.add(image.content), "mimeType": image.media_type}]
    return _file(content | buffer.content(), buffer.bytes)


class _Buffer:
    """What the JSON part points into, while it is filled."""

    def __init__(self):
        self.bytes, self._views, self._accessors = b"", [], []

    def add(self, content, **about):
        """The index of the view of these bytes."""
        self._views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content), **about})
        self.bytes += _aligned(content, b"\0")
        return len(self._views) - 1

    def add_array(self, rows, target, kind, with_bounds=False):
        """The index of the accessor of an array's rows, scalars or vectors."""
        size = "SCALAR" if rows.shape[1] == 1 else f"VEC{rows.shape[1]}"
        view = self.add(rows.tobytes(), target=target)
        accessor = {"bufferView": view, "componentType": kind, "count": len(rows), "type": size}
        if with_bounds:
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def content(self):
        buffers = [{"byteLength": len(self.bytes)}]
        return {"accessors": self._accessors, "bufferViews": self._views, "buffers": buffers}


def _file(content, binary):
    text = _aligned(json.dumps(content, separators=(",", ":"), allow_nan=False).encode(), b" ")
    chunks = _chunk(JSON, text) + _chunk(BINARY, binary)
    return struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks


def _chunk(kind, content):
    return struct.pack("<II", len(content), kind) + content


def _aligned(content, filler):
    return content + filler * (-len(content) % ALIGNMENT)


def placed(content, path, notes):
    """Yields (points, triangles, matrix), and adds to the notes. @throws InvalidMesh, OSError, and what a damaged file
    leads to"""
    binary = b""
    if content[:4] == struct.pack("<I", MAGIC):
        _check_version(*struct.unpack_from("<I", content, 4))
        content, binary = _chunks(content)
    about, _ = json.JSONDecoder().raw_decode(content.decode("utf-8-sig").lstrip())  # some writers pad the text
    scene = _Scene(about, binary, Path(path).parent)
    scene.check()
    for mesh, matrix in scene.meshes():
        for primitive in mesh["primitives"]:
            if primitive.get("mode", TRIANGLES) in (TRIANGLES, STRIP, FAN) and "POSITION" in primitive["attributes"]:
                yield *scene.triangles(primitive), matrix
            else:
                notes.append("its points, lines and primitives without positions are not read")


def _check_version(version):
    if str(version).partition(".")[0] != "2":  # a number in a GLB, "2.0" in its JSON
        raise InvalidMesh(f"this is glTF {version}; 2.0 is needed")


def _check_compression(extensions):
    for name in extensions:
        if "compression" in name:
            raise InvalidMesh(f"it is compressed ({name}); save it without")


def _chunks(content):
    """(JSON, binary) of a GLB file."""
    found, place = {}, 12
    while place + 8 <= len(content):
        size, kind = struct.unpack_from("<II", content, place)
        found.setdefault(kind, content[place + 8 : place + 8 + size])
        place += 8 + size
    return found[JSON], found.get(BINARY, b"")


class _Scene:
    def __init__(self, content, binary, folder):
        self._content, self._binary, self._folder, self._buffers = content, binary, folder, {}

    def check(self):
        _check_version(self._content["asset"]["version"])
        _check_compression(self._content.get("extensionsRequired", []))

    def meshes(self):
        """(mesh, matrix) of each node of the scene, from its roots down."""
        nodes = self._content.get("nodes", [])
        waiting = [(root, np.eye(4)) for root in self._roots(nodes)]
        for _ in nodes:
            if not waiting:
                return
            index, above = waiting.pop()
            node = nodes[index]
            matrix = _matrix(node) @ above
            if "mesh" in node:  # a skin puts its mesh where its bones are, wherever the node is
                mesh, place = self._content["meshes"][node["mesh"]], np.eye(4) if "skin" in node else matrix
                for instance in self._instances(node):
                    yield mesh, instance @ place
            waiting += [(child, matrix) for child in reversed(node.get("children", []))]
        if waiting:
            raise InvalidMesh("its nodes are no tree")

    def _instances(self, node):
        """Matrices of the places that an extension lists, or of the only one."""
        about = node.get("extensions", {}).get(INSTANCES, {}).get("attributes", {})
        rows = {name.lower(): self._rows(index) for name, index in about.items() if not name.startswith("_")}
        for places in zip(*rows.values()) if rows else [()]:
            yield _matrix(dict(zip(rows, places)))

    def _roots(self, nodes):
        if "scenes" in self._content:
            return self._content["scenes"][self._content.get("scene", 0)].get("nodes", [])[::-1]
        return sorted({*range(len(nodes))} - {child for node in nodes for child in node.get("children", [])})[::-1]

    def triangles(self, primitive):
        """(points, (#T, 3)), in which no triangle is there for points and lines."""
        if "bufferView" not in self._content["accessors"][primitive["attributes"]["POSITION"]]:
            _check_compression(primitive.get("extensions", {}))
        points = self._rows(primitive["attributes"]["POSITION"]).astype(float)
        indices = np.arange(len(points))
        if "indices" in primitive:
            indices = self._rows(primitive["indices"])[:, 0].astype(np.int64)
        mode = primitive.get("mode", TRIANGLES)
        if mode == TRIANGLES:
            return points, indices[: len(indices) // 3 * 3].reshape(-1, 3)
        if mode == STRIP:
            return points, arrays.strip_triangles(indices, np.array([0, len(indices)]))
        return points, np.column_stack([np.repeat(indices[:1], max(len(indices) - 2, 0)), indices[1:-1], indices[2:]])

    def _rows(self, index):
        """(n, 1, 3 or 4) of an accessor."""
        about = self._content["accessors"][index]
        kind = np.dtype(NUMBERS[about["componentType"]])
        if "bufferView" in about:
            rows = self._stored(index, about, kind)
        elif "sparse" in about and about["count"] <= MOST_ROWS:
            rows = np.zeros((about["count"], WIDTHS[about["type"]]), kind)
        else:
            raise InvalidMesh(f"accessor {index} has no numbers")
        if sparse := about.get("sparse"):
            rows, count = rows.copy(), {"count": sparse["count"]}
            places = {"type": "SCALAR"} | count | sparse["indices"]
            changed = self._stored(index, places, np.dtype(NUMBERS[places["componentType"]]))[:, 0]
            rows[changed] = self._stored(index, {"type": about["type"]} | count | sparse["values"], kind)
        if about.get("normalized"):
            return np.maximum(rows / np.iinfo(kind).max, -1)
        return rows

    def _stored(self, index, about, kind):
        """(n, 1, 3 or 4) of a view of a buffer."""
        view = self._content["bufferViews"][about["bufferView"]]
        if "uri" not in self._content["buffers"][view["buffer"]] and not self._binary:
            _check_compression(view.get("extensions", {}))
        width, start = WIDTHS[about["type"]], view.get("byteOffset", 0)
        content = self._buffer(view["buffer"])[start : start + view["byteLength"]]
        stride, count = view.get("byteStride", kind.itemsize * width), about["count"]
        if stride < kind.itemsize * width:
            raise InvalidMesh(f"rows of accessor {index} overlap")
        return np.ndarray((count, width), kind, content, about.get("byteOffset", 0), (stride, kind.itemsize))

    def _buffer(self, index):
        if index not in self._buffers:
            address = self._content["buffers"][index].get("uri")
            if address is None:
                found = self._binary
            elif address.startswith("data:"):
                found = base64.b64decode(address.partition(",")[2], validate=True)
            else:
                found = whole_file.read(self._folder / unquote(address))
            self._buffers[index] = found
        return self._buffers[index]


def _matrix(node):
    """(4, 4), which multiplies rows from the right, as files list it."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4)
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), float)
    turn = np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y + z * w), 2 * (x * z - y * w)],
            [2 * (x * y - z * w), w * w - x * x + y * y - z * z, 2 * (y * z + x * w)],
            [2 * (x * z + y * w), 2 * (y * z - x * w), w * w - x * x - y * y + z * z],
        ]
    )
    result = np.eye(4)
    result[:3, :3] = np.reshape(node.get("scale", [1, 1, 1]), (3, 1)) * turn
    result[3, :3] = node.get("translation", [0, 0, 0])
    return result
