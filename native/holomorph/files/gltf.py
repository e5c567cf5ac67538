"""Binary glTF 2.0 of one mesh: positions, UVs, and a texture that repeats."""

import json
import struct

from ..core import arrays

MAGIC, VERSION = 0x46546C67, 2
JSON, BINARY = 0x4E4F534A, 0x004E4942  # kinds of chunks
ALIGNMENT = 4  # bytes
VERTICES, INDICES = 34962, 34963  # what a part of the buffer is for
FLOAT, UNSIGNED = 5126, 5125
SAMPLER = {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}  # smooth at any distance, repeating
ROUGHNESS = 0.8


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
