"""Small files as people bring them, for every door: OBJ, OFF, PLY, STL and glTF, clean and dirty."""

import importlib.util
import json
import struct
from dataclasses import replace

import families
import mesh_files
import numpy as np
from repository import SHARED

SMALL = 1600  # faces of the hard cases and of the shared files, at most
TORUS = families.single(families.torus(16, 8, jitter=0.15))  # uneven: no map is as good as another one
RING = families.single(families.torus(16, 8, R=4.0, jitter=0.15))  # tilings are better by far than islands
SPHERE = families.single(families.geodesic_sphere(3))
WALL = families.single(families.cylinder(12, 5))


def parted(mesh, groups):
    """The mesh with vertices apart between groups, (#F,) numbers: as files have it that split them along UV seams."""
    sizes = np.diff(mesh.offsets)
    keys = np.column_stack([mesh.corners, np.repeat(groups, sizes)])
    kept, corners = np.unique(keys, axis=0, return_inverse=True)
    return replace(mesh, vertices=mesh.vertices[kept[:, 0]], corners=corners.ravel())


def in_charts(mesh):
    """Apart along the seams of four charts."""
    centres = np.array([mesh.vertices[face].mean(axis=0) for face in mesh.faces])
    return parted(mesh, 2 * (centres[:, 0] > 0) + (centres[:, 1] > 0))


def of_faces(mesh):
    """Each face with vertices of its own."""
    return parted(mesh, np.arange(mesh.face_count))


def two_sided(mesh, shared=False):
    """Each face also the other way round, on the same vertices or on further ones."""
    start = 0 if shared else len(mesh.vertices)
    back = families.mirrored(mesh)
    points = mesh.vertices if shared else np.concatenate([mesh.vertices] * 2)
    corners = np.concatenate([mesh.corners, back.corners + start])
    offsets = np.concatenate([mesh.offsets, mesh.offsets[1:] + mesh.offsets[-1]])
    return replace(mesh, vertices=points, corners=corners, offsets=offsets)


def with_faces(mesh, *faces, points=()):
    return families.polygons([*mesh.vertices, *points], [*(f.tolist() for f in mesh.faces), *map(list, faces)])


def moved(mesh, *offset):
    return replace(mesh, vertices=mesh.vertices + offset)


PAIR = families.united(TORUS, SPHERE)
MESHES = {
    "torus": TORUS,
    "wall": WALL,
    "pair": PAIR,
    "in_charts": in_charts(TORUS),
    "in_charts_far": in_charts(families.single(moved(TORUS, 300.0, 200.0, -700.0))),
    "of_faces": of_faces(TORUS),
    "of_faces_pair": of_faces(PAIR),
    "two_sided": two_sided(RING),
    "two_sided_shared": two_sided(WALL, shared=True),
    "two_sided_of_faces": of_faces(two_sided(RING)),
    "twice": with_faces(TORUS, TORUS.faces[3], TORUS.faces[9]),
    "slivers": families.with_slivers(TORUS, 4),
    "slivers_at_ends": families.with_slivers(TORUS, 3, kind="end"),
    "fin": with_faces(TORUS, [0, 1, len(TORUS.vertices)], points=[[0.0, 0.0, 3.0]]),
    "touching": with_faces(TORUS, [0, len(TORUS.vertices), len(TORUS.vertices) + 1], points=[[9, 0, 0], [9, 1, 0]]),
    "one_sided": families.moebius(),
    "lone_vertices": replace(TORUS, vertices=np.concatenate([TORUS.vertices, TORUS.vertices[:5]])),
    "vertex_twice": with_faces(TORUS, [0, 1, 1, 2]),
    "of_two_corners": with_faces(TORUS, [0, 1]),
    "wild": with_faces(TORUS, [0, 1, len(TORUS.vertices)], points=[[1e13, 0.0, 0.0]]),
    "not_finite": with_faces(TORUS, [0, 1, len(TORUS.vertices)], points=[[np.nan, 0.0, 0.0]]),
    "reversed": families.partly_reversed(TORUS),
    "spun": families.spun(12, 6),
    "flat": replace(WALL, vertices=WALL.vertices * [1, 1, 0]),
    "without_area": replace(WALL, vertices=WALL.vertices * [1, 0, 0]),
}


def textured(mesh, separator=" ", first=1):
    """OBJ with UVs, normals and a material; `first` is that of the numbers, below 0 from the end."""
    numbers = mesh.corners + 1 if first > 0 else mesh.corners - len(mesh.vertices)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    lines += [f"vt{separator}{x!r}{separator}{y!r}" for x, y in mesh.vertices[:, :2].tolist()]
    lines += [f"usemtl{separator}Red"]
    lines += ["f " + " ".join(f"{v}/{v}" for v in face) for face in np.split(numbers, mesh.offsets[1:-1])]
    return ("\n".join(lines) + "\n").encode()


def objects(*meshes):
    """OBJ of several objects."""
    lines, first = [], 1
    for number, mesh in enumerate(meshes):
        lines += [f"o part{number}", *(f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist())]
        lines += ["f " + " ".join(str(v + first) for v in face) for face in mesh.faces]
        first += len(mesh.vertices)
    return ("\n".join(lines) + "\n").encode()


def gltf(*nodes):
    """glTF with its buffer beside it in one file (GLB): a node for each list of meshes, which are its primitives."""
    binary, views, accessors, meshes = b"", [], [], []

    def add(rows, kind, code):
        nonlocal binary
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": rows.nbytes})
        bounds = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()} if kind == "VEC3" else {}
        about = {"bufferView": len(views) - 1, "componentType": code, "count": len(rows), "type": kind}
        accessors.append(about | bounds)
        binary += rows.tobytes()
        return len(accessors) - 1

    for primitives in nodes:
        made = [
            {
                "attributes": {"POSITION": add(np.float32(m.vertices), "VEC3", 5126)},
                "indices": add(_triangles(m), "SCALAR", 5125),
            }
            for m in primitives
        ]
        meshes.append({"primitives": made})
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": [{"mesh": k, "name": f"Node{k}"} for k in range(len(nodes))],
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def _triangles(mesh):
    fans = [[face[0], face[k], face[k + 1]] for face in mesh.faces for k in range(1, len(face) - 1)]
    return np.array(fans, np.uint32).reshape(-1, 1)


def own_files():
    """{name: bytes}"""
    found = {f"{name}.obj": mesh_files.obj(mesh) for name, mesh in MESHES.items()}
    found |= {f"{name}.ply": mesh_files.ply_binary(MESHES[name]) for name in ("in_charts", "of_faces", "two_sided")}
    found |= {f"{name}.off": mesh_files.off(MESHES[name]) for name in ("in_charts", "two_sided")}
    triangles = families.triangles_of(TORUS)
    found |= {
        "torus.stl": mesh_files.stl_binary(triangles),
        "two_sided.stl": mesh_files.stl_binary(two_sided(triangles)),
    }
    found |= {
        "tabs.obj": textured(TORUS, separator="\t"),
        "from_the_end.obj": textured(TORUS, first=-1),
        "textured_in_charts.obj": textured(MESHES["in_charts"]),
        "objects.obj": objects(TORUS, moved(SPHERE, 5, 0, 0)),
        "beyond.obj": mesh_files.obj(TORUS) + b"f 1 2 999\n",
        "nothing.obj": b"# nothing\n",
        "no_faces.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\n",
        "binary.obj": b"\0\0\0",
    }
    names = (
        "torus",
        "in_charts",
        "in_charts_far",
        "of_faces",
        "two_sided",
        "two_sided_shared",
        "two_sided_of_faces",
        "wall",
    )
    found |= {f"{name}.glb": gltf([MESHES[name]]) for name in names}
    found["primitives.glb"] = gltf([TORUS, moved(SPHERE, 5, 0, 0)])
    found["nodes.glb"] = gltf([MESHES["of_faces"]], [moved(SPHERE, 5, 0, 0)])
    some = (
        "windows.obj",
        "continued.obj",
        "normals.obj",
        "coloured vertices.off",
        "commented.off",
        "text.ply",
        "big.ply",
        "text.stl",
    )
    files = mesh_files.POLYGON_FILES | mesh_files.TRIANGLE_FILES
    return found | {name.replace(" ", "_"): files[name] for name in some}


def shared_files():
    """{name: bytes} of ../shared, if it is there: cases, small props, hard cases."""
    paths = sorted((SHARED / "cases").glob("*.*")) + sorted((SHARED / "props").glob("*.glb"))
    wanted = [path for path in paths if path.suffix in (".obj", ".off", ".ply", ".stl", ".glb")]
    found = {path.name: path.read_bytes() for path in wanted if not path.name.startswith("relief")}
    script = SHARED / "tools" / "hard_cases.py"
    if not script.is_file():
        return found
    spec = importlib.util.spec_from_file_location("hard_cases", script)
    hard = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hard)
    for name in hard.NAMES:
        mesh = families.polygons(*hard.make(name))
        if mesh.face_count <= SMALL:  # the costly ones show nothing more
            found[f"hard_{name}.obj"] = mesh_files.obj(mesh)
    return found
