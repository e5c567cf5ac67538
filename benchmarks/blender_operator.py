# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole operator in Blender, reading and writing included, beside Blender's own unwrap of the same mesh.

    blender -b --factory-startup --python-exit-code 1 --python benchmarks/blender_operator.py -- [--faces 1000000]
        [--main AUTOMATIC | BALANCED] [--method CONFORMAL | ANGLE_BASED | NONE] [--json FILE]

The mesh is a torus of triangles. For Blender's unwrap one meridian and one parallel are marked as seams, which makes
it a disk; the operator needs no seams, and its main map is what the button takes, or the balanced one. It runs on
three objects, each of them new to it, then Blender's unwrap once, which takes minutes. Prints the seconds of the
first run, for which the package is loaded and the system makes the memory, and of the median of all, the ratio of
Blender's to each, and the peak memory of the process after the first.
"""

import argparse
import json
import resource
import statistics
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import addon
import addon.native

RUNS = 3


def torus(faces, major=1.0, minor=0.4):
    """Vertices and triangles of a torus of revolution with nearly square cells."""
    across = round((faces / 2 * minor / major) ** 0.5)
    around = round(faces / 2 / across)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = 2 * np.pi * i / around, 2 * np.pi * j / across
    ring = major + minor * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(v)], -1).reshape(-1, 3)
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    triangles = np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)
    return vertices.astype(np.float32), triangles.astype(np.int32), across


def make_object(vertices, triangles, across):
    mesh = bpy.data.meshes.new("torus")
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.update(calc_edges=True)
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    row, column = np.divmod(ends.reshape(-1, 2), across)
    seam = ((row == 0).all(1)) | ((column == 0).all(1) & (row[:, 0] != row[:, 1]))
    mesh.edges.foreach_set("use_seam", seam)
    obj = bpy.data.objects.new("torus", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.context.view_layer.update()  # Blender's own work on a new object, which belongs to neither
    return obj


def timed(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--faces", type=int, default=1_000_000)
    parser.add_argument("--main", default="AUTOMATIC")
    parser.add_argument("--method", default="CONFORMAL")
    parser.add_argument("--json")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    addon.register()
    result = {"blender": bpy.app.version_string, "main_map": options.main}
    runs = []
    for _ in range(RUNS):
        bpy.ops.wm.read_factory_settings(use_empty=True)  # with the last object, the kept solve goes as well
        obj = make_object(*torus(options.faces))
        runs.append(timed(lambda: bpy.ops.uv.holomorphic_maps(main=options.main)))
        result.setdefault("peak_memory_MB", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000)
    result |= {"faces": len(obj.data.polygons), "operator_first": runs[0], "operator": statistics.median(runs)}
    if options.method != "NONE":
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        result["unwrap"] = timed(lambda: bpy.ops.uv.unwrap(method=options.method, margin=0.0))
        result["unwrap_method"] = options.method
        for name in ("operator_first", "operator"):
            result[name.replace("operator", "ratio")] = result["unwrap"] / result[name]
    addon.unregister()
    print(json.dumps(result, indent=1))
    if options.json:
        Path(options.json).write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


main()
