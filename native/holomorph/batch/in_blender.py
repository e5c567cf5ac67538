"""Run by Blender, imported by nothing: reads the mesh objects of a scene into arrays, and writes maps to them.

blender -b FILE.blend --python in_blender.py -- FILE.blend read FOLDER
blender -b [FILE.blend] --python in_blender.py -- [FILE.blend] write MESH.npz TARGET.blend OBJECT

A file of another program (glTF, FBX, USD) is named after -- alone. Names of operators at the end, such as
import_scene.fbx, say what imports it: the first that there is.
"""

import json
import sys
from pathlib import Path

import bpy
import numpy as np

MAP = "Holomorphic"
IMPORTER_HELPERS = "glTF_not_exported"  # the collection of shapes of bones, which the glTF importer makes


def open_scene(path, importers):
    """Imports what is no .blend file. Blender goes on with an empty scene where it cannot read one."""
    if importers:
        bpy.data.batch_remove(list(bpy.data.objects))
        if "bool" not in vars(np):  # glTF's of Blender 3.4 uses it, NumPy 1.24 beside it in Debian has it not
            np.bool = bool
        try:
            importer(importers)(filepath=str(path))
        except (RuntimeError, AttributeError) as error:  # the latter where Blender was built without it
            lines = [line.strip() for line in str(error).splitlines()]
            told = [line for line in lines if line and not line.startswith(("Location:", "File "))]
            sys.exit(f"this Blender cannot import it: {told[-1] if told else path}")
    elif Path(bpy.data.filepath) != Path(path):
        sys.exit("this is not a .blend file that this Blender reads")


def importer(names):
    """The first of these operators that this Blender has, or the last."""
    for room, name in (each.split(".") for each in names):
        if name in dir(getattr(bpy.ops, room)):
            break
    return getattr(getattr(bpy.ops, room), name)


def is_helper(obj):
    """Whether the importer made the object for its own use, so that it is not part of the scene."""
    return any(collection.name.startswith(IMPORTER_HELPERS) for collection in obj.users_collection)


def read(path, folder, *importers):
    """One .npz file for each mesh object with faces, as it is seen: scaled, without modifiers."""
    open_scene(path, importers)
    bpy.context.view_layer.update()  # the objects' matrices
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH" and len(obj.data.polygons) and not is_helper(obj)]
    listed = []
    for number, obj in enumerate(sorted(meshes, key=lambda obj: obj.name)):
        arrays = mesh_arrays(obj)
        np.savez(Path(folder, f"{number}.npz"), **arrays)
        listed.append([obj.name, f"{number}.npz", len(arrays["corner_vertices"])])
    if not listed:
        sys.exit("there is no mesh object with faces in the file")
    Path(folder, "objects.json").write_text(json.dumps(listed), encoding="utf-8")


def mesh_arrays(obj):
    mesh, matrix = obj.data, np.array(obj.matrix_world, float)
    points = values(mesh.vertices, "co", np.float32, 3)
    sizes = values(mesh.polygons, "loop_total", np.int32)
    edges = values(mesh.edges, "vertices", np.int32, 2)
    return {
        "vertices": points.astype(float) @ matrix[:3, :3].T,
        "corner_vertices": values(mesh.loops, "vertex_index", np.int32),
        "face_offsets": np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        "seams": edges[values(mesh.edges, "use_seam", bool)],
    }


def values(elements, name, kind, columns=1):
    found = np.empty(len(elements) * columns, kind)
    elements.foreach_get(name, found)
    return found if columns == 1 else found.reshape(-1, columns)


def write(path, arrays, target, name, *importers):
    """Saves the file, or a new one, with the maps on the object `name`."""
    if path is None:
        bpy.data.batch_remove(list(bpy.data.objects))
    else:
        open_scene(path, importers)
    with np.load(arrays) as found:
        mesh = new_mesh(name, found) if path is None else bpy.data.objects[name].data
        maps = [name for name in found.files if name == "uv" or name.startswith("uv_")]
        for uv in maps:
            add_map(mesh, uv.replace("uv_", f"{MAP} ").replace("uv", MAP), found[uv], found["corner_index"])
    mesh.uv_layers.active = mesh.uv_layers[MAP]
    mesh.uv_layers[MAP].active_render = True
    bpy.ops.wm.save_as_mainfile(filepath=target, check_existing=False, compress=True, relative_remap=True)


def new_mesh(name, arrays):
    """Makes a mesh object of the surface, linked to the scene."""
    corners, offsets = arrays["corner_vertices"], arrays["face_offsets"]
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(arrays["vertices"]))
    mesh.vertices.foreach_set("co", arrays["vertices"].astype(np.float32).ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners.astype(np.int32))
    mesh.polygons.add(len(offsets) - 1)
    mesh.polygons.foreach_set("loop_start", offsets[:-1].astype(np.int32))
    mesh.polygons.foreach_set("loop_total", np.diff(offsets).astype(np.int32))
    mesh.update(calc_edges=True)
    mesh.validate()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    return mesh


def add_map(mesh, name, uv, corner_index):
    """Replaces a map; corners of the file that the surface has not are 0."""
    if name in mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[name])
    layer = mesh.uv_layers.new(name=name)
    if layer is None:
        sys.exit(f"no slot is free for the UV map {name}: Blender allows 8")
    rows = np.zeros((len(mesh.loops), 2), np.float32)
    rows[corner_index if len(corner_index) != len(rows) else slice(None)] = uv
    layer.data.foreach_set("uv", rows.ravel())


def main(arguments):
    mode = next(index for index, word in enumerate(arguments) if word in ("read", "write"))
    path = arguments[0] if mode else None
    {"read": read, "write": write}[arguments[mode]](path, *arguments[mode + 1 :])


main(sys.argv[sys.argv.index("--") + 1 :])
