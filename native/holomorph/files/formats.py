"""Meshes with UVs as files. Every writer gives bytes, the same for the same mesh on every run."""

import io
import os
from pathlib import Path

import numpy as np

from .._native import InvalidMesh
from ..core import arrays
from . import gltf, scenes, textures, whole_file


def write(surface, path, uv=None, texture=None):
    """See `Surface.write`."""
    name = of_path(path)
    if surface.vertices is None:
        raise InvalidMesh("an intrinsic surface, without positions, cannot be written")
    if uv is not None:
        uv, count = arrays.numbers(uv, "uv"), len(surface.corner_vertices)
        if uv.shape != (count, 2) or not np.isfinite(uv).all():
            raise ValueError(f"uv has the shape {uv.shape}; ({count}, 2) finite numbers are needed")
    image = None
    if texture is not None:
        check_texture(name, texture)
        if uv is None:
            raise ValueError("a texture needs uv, its map on the surface")
        image = textures.image(texture, surface, uv)
    whole_file.write(path, content(name, surface, uv, image))


def content(name, surface, uv=None, image=None):
    """The bytes of a file. name : in `WRITERS`; image : a `textures.Image` for formats that are `TEXTURED`"""
    return WRITERS[name](surface, uv, image) if name in TEXTURED else WRITERS[name](surface, uv)


def check_texture(name, texture):
    """@throws ValueError, OSError where files of a format cannot have a texture, or it is not an image"""
    if name not in TEXTURED:
        raise ValueError(f"a texture goes into .{' and .'.join(TEXTURED)} files alone, not into .{name}")
    textures.check(texture)


def of_path(path, writers=None):
    """The name of the format that a path ends with, in `WRITERS` or others.

    Raises ValueError for any other ending."""
    name, known = Path(path).suffix.lower().removeprefix("."), writers or WRITERS
    if name not in known:
        endings = [f".{each}" for each in known]
        wanted = f"{', '.join(endings[:-1])} or {endings[-1]}"
        raise ValueError(f"{path} must end with {wanted}")
    return name


def check_mesh(path):
    """@throws InvalidMesh, OSError where a path is that of no mesh file, whatever the file holds"""
    require_reader(path)
    whole_file.require_file(path)


def require_reader(path):
    """@throws InvalidMesh for a path that does not end as those of mesh files"""
    name = os.fsdecode(path)
    if Path(name).suffix.lower() not in READERS:
        raise InvalidMesh(f"{name}: the file name must end in {', '.join(READERS[:-1])} or {READERS[-1]}")


def npz(surface, arrays):
    """NumPy arrays, double precision: the mesh and all its maps."""
    buffer = io.BytesIO()
    mesh = {name: getattr(surface, name) for name in ("vertices", "corner_vertices", "face_offsets")}
    np.savez_compressed(buffer, **mesh, **arrays)
    return buffer.getvalue()


def obj(surface, uv=None):
    """Wavefront OBJ: polygons as they are, with 17 digits, so that no bit is lost."""
    text = text_of("v %.17g %.17g %.17g\n", surface.vertices)
    corners, entry = surface.corner_vertices + 1, " %d"
    if uv is not None:
        values, places = _distinct(uv)
        text += text_of("vt %.17g %.17g\n", values)
        corners, entry = np.column_stack([corners, places + 1]), " %d/%d"
    sizes = np.diff(surface.face_offsets)
    faces = [entry * size for size in range(int(sizes.max()) + 1)]
    lines = "".join(["f" + faces[size] + "\n" for size in sizes.tolist()])
    return (text + lines % tuple(corners.ravel().tolist())).encode()


def ply(surface, uv=None):
    """Binary PLY: vertices with s and t, as applications read them, so that a vertex on a seam is there several times;
    polygons as they are."""
    points, corners = _split(surface, uv)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property double {name}" for name in "xyzst"[: points.shape[1]]]
    header += [f"element face {len(surface.face_offsets) - 1}", "property list int int vertex_indices", "end_header\n"]
    starts = surface.face_offsets[:-1]
    faces = np.insert(corners, starts, np.diff(surface.face_offsets))
    return "\n".join(header).encode() + points.astype("<f8").tobytes() + faces.astype("<i4").tobytes()


def glb(surface, uv=None, image=None):
    """Binary glTF of the triangles. image : a `textures.Image`, which the UVs lay on them"""
    points, corners = _split(surface, uv)
    triangles = corners[surface.triangle_corners]
    if uv is None:
        return gltf.encoded(points, triangles)
    return gltf.encoded(points[:, :3], triangles, points[:, 3:], image)


KINDS = "OBJ, OFF, PLY, STL, glTF or 3MF"  # of the files that `Surface.read` reads
POLYGONAL = (".obj", ".off", ".ply", ".stl")  # those of one mesh of polygons, which the native part reads
READERS = (*POLYGONAL, *scenes.KINDS)
WRITERS = {"obj": obj, "ply": ply, "glb": glb}
TEXTURED = ("glb",)

# Files of scenes, which Blender reads, and its operators for that, of which a version has one or more.
IMPORTERS = {
    ".blend": (),
    **dict.fromkeys((".glb", ".gltf"), ("import_scene.gltf",)),
    ".fbx": ("wm.fbx_import", "import_scene.fbx"),
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), ("wm.usd_import",)),
}


def text_of(template, rows):
    """The text of all rows of an array, each as the template has it."""
    return template * len(rows) % tuple(rows.ravel().tolist())


def _distinct(rows):
    """The distinct rows, and for each row its place among them."""
    rows = np.ascontiguousarray(rows)
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1])))[:, 0]
    _, first, places = np.unique(keys, return_index=True, return_inverse=True)
    return rows[first], places.ravel()


def _split(surface, uv):
    """((#P, 5) positions and UVs, (#C,) corners): a point for each vertex and each UV it has. (#V, 3) positions
    without UVs."""
    if uv is None:
        return surface.vertices, surface.corner_vertices
    return _distinct(np.column_stack([surface.vertices[surface.corner_vertices], uv]))
