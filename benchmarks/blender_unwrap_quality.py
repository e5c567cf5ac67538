# SPDX-License-Identifier: GPL-3.0-or-later
"""Angle distortion beside Blender's own unwrap of the same triangles, cut along the same seams, in the same run.

    blender -b --factory-startup --python-exit-code 1 --python benchmarks/blender_unwrap_quality.py -- \\
        MESH... [--json FILE]

For each closed mesh of genus >= 1: mean s1/s2 of the best form of the basis and of the balanced map; the same of
Blender's Angle Based and Conformal unwrap, and how much the two copies of a seam edge differ there in length (factor)
and angle.
"""

import argparse
import json
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import addon.native


def triangle_mesh(surface):
    """The library's own triangles as a Blender mesh, with the corners in the library's order."""
    mesh = bpy.data.meshes.new("triangles")
    mesh.from_pydata(surface.vertices, [], surface.triangles.tolist())
    obj = bpy.data.objects.new("triangles", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def mark_seams(mesh, pairs):
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    key = np.sort(ends.reshape(-1, 2)).astype(np.int64) @ [len(mesh.vertices), 1]
    mesh.edges.foreach_set("use_seam", np.isin(key, pairs.astype(np.int64) @ [len(mesh.vertices), 1]))


def unwrap(obj, method):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.unwrap(method=method, correct_aspect=False, margin=0.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = np.empty(2 * len(obj.data.loops), np.float32)
    obj.data.uv_layers.active.data.foreach_get("uv", uv)
    return uv.reshape(-1, 2).astype(np.float64)


def seam_mismatch(triangles, uv, pairs, vertex_count):
    """Mean factor in length and mean angle in degrees between the two copies of each seam edge."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    corners = uv.reshape(-1, 3, 2)
    step = (np.roll(corners, -1, axis=1) - corners).reshape(-1, 2) @ [1, 1j] * np.where(start < end, 1, -1)
    key = np.minimum(start, end).astype(np.int64) * vertex_count + np.maximum(start, end)
    chosen = np.isin(key, pairs.astype(np.int64) @ [vertex_count, 1])
    order = np.argsort(key[chosen], kind="stable")
    one, other = step[chosen][order].reshape(-1, 2).T
    return float(np.exp(np.abs(np.log(np.abs(one / other))).mean())), float(
        np.degrees(np.abs(np.angle(one / other))).mean()
    )


def compare(holomorph, path):
    polygons = holomorph.Surface.read(path).components[0]
    surface = holomorph.Surface(polygons.vertices, np.asarray(polygons.triangles))  # for Blender and for us alike
    structure = holomorph.conformal_structure(surface)
    pairs = structure.edges[structure.seams]
    forms = [structure.quality(structure.uv(c)) for c in np.eye(surface.genus)]
    balanced = structure.quality(structure.uv(structure.balanced_coefficients()))
    best = min(forms, key=lambda q: q.mean_angle)
    row = {
        "mesh": Path(path).name,
        "best_form": best.mean_angle,
        "best_form_flipped": int(best.flipped.sum()),
        "balanced": balanced.mean_angle,
        "density_ratio": balanced.density_ratio,
        "seam_mismatch": seam_mismatch(
            surface.triangles,
            structure.uv(np.eye(surface.genus)[0])[surface.triangle_corners.ravel()],
            pairs,
            len(surface.vertices),
        ),
    }
    obj = triangle_mesh(surface)
    mark_seams(obj.data, pairs)
    for method in ("ANGLE_BASED", "CONFORMAL"):
        uv = unwrap(obj, method)
        row[method] = structure.quality(uv).mean_angle
        row[method + "_seam_mismatch"] = seam_mismatch(surface.triangles, uv, pairs, len(surface.vertices))
    bpy.data.objects.remove(obj)
    return row


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--json")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    holomorph = addon.native.load()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rows = [compare(holomorph, path) for path in options.meshes]
    print(json.dumps(rows, indent=1))
    if options.json:
        Path(options.json).write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


main()
