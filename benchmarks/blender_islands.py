# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands beside Blender's own unwrapping, in the same run, with the same seams: the borders of Smart UV's islands.

    blender -b --factory-startup --python-exit-code 1 --python benchmarks/blender_islands.py -- \\
        MESH... [--json FILE]

For each mesh file: angle distortion, size range, part of the UV square
that is filled, and part of the filled region that is covered twice, of Smart UV Project, Unwrap by each method that
this Blender has, and Holomorph's main map *Islands*. All are packed with the same margin, Blender's with rotation and
with equal texel density.
"""

import argparse
import json
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import addon
from addon import native

MARGIN = 0.004  # of the UV square
METHODS = ("ANGLE_BASED", "CONFORMAL", "MINIMUM_STRETCH")


def mesh_object(surface, name):
    from addon.scene import mesh_io

    mesh = mesh_io.new_mesh(name, surface.vertices, surface.corner_vertices, surface.face_offsets)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def in_edit_mode(*operators):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    for operator, options in operators:
        operator(**options)
    bpy.ops.object.mode_set(mode="OBJECT")


def pack():
    return [
        (bpy.ops.uv.average_islands_scale, {}),
        (bpy.ops.uv.pack_islands, {"rotate": True, "margin_method": "ADD", "margin": MARGIN}),
    ]


def measured(holomorph, surface, obj):
    """The quality of the active UV map."""
    from holomorph.quality.appearance import overlapping_part
    from holomorph.quality.quality import Quality

    uv = np.empty(2 * len(obj.data.loops), np.float32)
    obj.data.uv_layers.active.data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 2).astype(np.float64)
    quality = Quality.of(surface._native, np.ascontiguousarray(uv[surface.corner_index]), 0)
    z = (uv @ [1, 1j])[surface.triangle_corners]
    area = np.abs(((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0])).imag / 2).sum()
    sides = np.stack([z, np.roll(z, -1, axis=1)], axis=-1).reshape(-1, 2)  # those inside cancel
    return {
        "angle distortion": quality.mean_angle,
        "size range": quality.size_range,
        "flipped": quality.flipped_part,
        "filled": float(area),
        "twice": overlapping_part(sides),
    }


def compare(holomorph, path):
    surface = holomorph.Surface.read(path)
    obj = mesh_object(surface, Path(path).stem)
    methods = {each.identifier for each in bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items}
    in_edit_mode((bpy.ops.uv.smart_project, {"island_margin": MARGIN}), (bpy.ops.uv.seams_from_islands, {}), *pack())
    row = {"mesh": obj.name, "triangles": len(surface.triangles), "SMART": measured(holomorph, surface, obj)}
    for method in METHODS:
        if method in methods:
            in_edit_mode((bpy.ops.uv.unwrap, {"method": method, "margin": MARGIN}), *pack())
            row[method] = measured(holomorph, surface, obj)
    bpy.ops.uv.holomorphic_maps(main="ISLANDS", margin=MARGIN, forms=0, checker=False)
    row["ISLANDS"] = measured(holomorph, surface, obj)
    bpy.data.objects.remove(obj)
    return row


def table(rows):
    """In Markdown: angle distortion and size range of each method, then how much is filled."""
    names = [name for name in ("SMART", *METHODS, "ISLANDS") if name in rows[0]]
    figures = {"angle distortion": ".3f", "size range": ".3g", "filled": ".0%"}
    heads = [f"{what} {name.title().replace('_', ' ')}" for what in figures for name in names]
    yield " | ".join(["", "mesh", *heads, ""]).strip()
    yield "|---" * (len(heads) + 1) + "|"
    for row in rows:
        cells = [f"{row[name][what]:{form}}" for what, form in figures.items() for name in names]
        yield " | ".join(["", row["mesh"], *cells, ""]).strip()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--json")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.register()
    rows = [compare(native.load(), path) for path in options.meshes]
    print("\n".join(table(rows)))
    if options.json:
        Path(options.json).write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


main()
