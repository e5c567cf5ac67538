"""The files of one mapped mesh. Every writer gives bytes, the same for the same mesh on every run."""

import importlib.util
import io

import numpy as np

from .errors import UsageError


def check(formats):
    """@throws UsageError where a library is missing that a format needs"""
    if "glb" in formats and importlib.util.find_spec("trimesh") is None:
        raise UsageError('the format glb needs the library trimesh: pip install "holomorph[batch]"')


def npz(surface, arrays):
    """NumPy arrays, double precision: the mesh and all its maps."""
    buffer = io.BytesIO()
    mesh = {name: getattr(surface, name) for name in ("vertices", "corner_vertices", "face_offsets")}
    np.savez_compressed(buffer, **mesh, **arrays)
    return buffer.getvalue()


def obj(surface, uv):
    """Wavefront OBJ: polygons as they are, 17 digits, which are all that there are."""
    values, places = _distinct(uv)
    corners = np.column_stack([surface.corner_vertices, places]) + 1
    sizes = np.diff(surface.face_offsets)
    faces = [" %d/%d" * size for size in range(int(sizes.max()) + 1)]
    lines = "".join(["f" + faces[size] + "\n" for size in sizes.tolist()])
    text = _lines("v %.17g %.17g %.17g\n", surface.vertices) + _lines("vt %.17g %.17g\n", values)
    return (text + lines % tuple(corners.ravel().tolist())).encode()


def ply(surface, uv):
    """Binary PLY: vertices with s and t, as applications read them, so that a vertex on a seam is there several times;
    polygons as they are."""
    points, corners = _split(surface, uv)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property double {name}" for name in ("x", "y", "z", "s", "t")]
    header += [f"element face {len(surface.face_offsets) - 1}", "property list int int vertex_indices", "end_header\n"]
    starts = surface.face_offsets[:-1]
    faces = np.insert(corners, starts, np.diff(surface.face_offsets))
    return "\n".join(header).encode() + points.astype("<f8").tobytes() + faces.astype("<i4").tobytes()


def glb(surface, uv):
    """Binary glTF of the triangles, by trimesh."""
    import trimesh

    points, corners = _split(surface, uv)
    mesh = trimesh.Trimesh(
        vertices=points[:, :3],
        faces=corners[surface.triangle_corners],
        visual=trimesh.visual.TextureVisuals(points[:, 3:], trimesh.visual.material.PBRMaterial()),
        process=False,
    )
    return mesh.export(file_type="glb")


def _lines(template, rows):
    return template * len(rows) % tuple(rows.ravel().tolist())


def _distinct(rows):
    """The distinct rows, and for each row its place among them."""
    rows = np.ascontiguousarray(rows)
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1])))[:, 0]
    _, first, places = np.unique(keys, return_index=True, return_inverse=True)
    return rows[first], places.ravel()


def _split(surface, uv):
    """((#P, 5) positions and UVs, (#C,) corners): a point for each vertex and each UV it has."""
    return _distinct(np.column_stack([surface.vertices[surface.corner_vertices], uv]))
