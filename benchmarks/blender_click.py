# SPDX-License-Identifier: GPL-3.0-or-later
"""The one button and *Seamless Tiling* beside Smart UV Project and Unwrap along Smart UV's seams, on every mesh object
of files, or on irregular surfaces of genus 2; with the packages xatlas and igl also these (other_unwraps.py).

    blender -b --factory-startup --python-exit-code 1 --python benchmarks/blender_click.py -- \\
        [FILE...] [--faces N...] [--packages FOLDER] [--json FILE] [--only-button]

With Blender as a Python module: python benchmarks/blender_click.py -- FILE...

A FILE is a mesh file that Blender reads or a .blend. For each object, of the button's map, the tiling, Smart UV's map
and those of Unwrap by each method that this Blender has: seconds of processor time, of all threads; the part of the
area without a map; the 95 : 5 % ratio of the texture's density by area; mean s1/s2 by area (each triangle 10 at most;
whichever way it faces, for in a one-sided mesh half of them face the other); and the length, over that of the object's
diagonal, of the edges across which a tiling texture breaks off, because the two sides do not differ by integers, after
quarter turns, which leave the checker as it is. The last columns say whether the button is no worse than each of the
others, see `is_no_worse`, and how many times faster it is than the fastest of those that are no worse than it.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import meshes
import other_unwraps

import addon
from addon import compatibility, native
from addon.scene import gathering, mesh_io
from addon.solving import jobs

LARGEST_STRETCH = 10.0
SAME = 1e-4  # of the UV square: coordinates that differ by less agree in single precision
LOST = 1e-6  # density over the median: a triangle that is smaller has no map
EVEN, HARDLY_LESS_EVEN = 3.0, 1.3  # a density ratio that is even, and the factor of another one's that is hardly more
UNSEEN_SHEAR, HARDLY_MORE_SHEARED = 1.3, 0.1  # mean s1/s2, where it is spread over the surface
HARDLY_LONGER = 1.01
UNWRAPS = {"ANGLE_BASED": "angle based", "MINIMUM_STRETCH": "minimum stretch"}
OTHERS = ("smart", *UNWRAPS.values(), "xatlas", "igl LSCM", "igl SLIM")
OURS = {"button": "holomorphic_maps", "tiling": "holomorphic_tile"}


def triangles_of(obj):
    """(#T, 3) loops, and vertices."""
    mesh = obj.data
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    return corners.reshape(-1, 3), vertices[corners].reshape(-1, 3)


def triangle_measures(obj, uv):
    """Areas in space, densities (area in UVs by area in space) and s1/s2 of the object's triangles."""
    corners, vertices = triangles_of(obj)
    x = mesh_io.world_points(obj)[vertices]
    z = uv[corners] @ [1, 1j]
    a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    area = np.linalg.norm(np.cross(a, b), axis=1) / 2
    keep = area > 1e-12 * area.sum()
    a, b, z, area = a[keep], b[keep], z[keep], area[keep]
    length = np.linalg.norm(a, axis=1)
    along = (a * b).sum(1) / length
    height = 2 * area / length
    du, dv = z[:, 1] - z[:, 0], z[:, 2] - z[:, 0]
    by_x = du / length
    by_y = (dv - by_x * along) / height
    holomorphic, other = np.abs(by_x - 1j * by_y) / 2, np.abs(by_x + 1j * by_y) / 2
    less = np.abs(holomorphic - other)
    stretch = np.divide(holomorphic + other, less, out=np.full(len(less), LARGEST_STRETCH), where=less > 0)
    return area, np.abs(holomorphic**2 - other**2), np.minimum(stretch, LARGEST_STRETCH)


def quantiles(area, density, parts):
    order = np.argsort(density)
    part = np.cumsum(area[order]) / area.sum()
    return density[order][np.minimum(np.searchsorted(part, parts), len(order) - 1)]


def visible_length(obj, uv):
    """Length of the edges that a tiling texture does not run across, over the diagonal of the object's box."""
    mesh = obj.data
    vertex = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertex)
    start, total = np.empty(len(mesh.polygons), np.int32), np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", start)
    mesh.polygons.foreach_get("loop_total", total)
    following = np.arange(1, len(mesh.loops) + 1)
    following[start + total - 1] = start
    edge, forward = edges(obj, vertex, following)
    z = uv @ [1, 1j]
    first, second = np.where(forward, z, z[following]), np.where(forward, z[following], z)
    order = np.argsort(edge, kind="stable")
    inner = np.flatnonzero(edge[order][1:] == edge[order][:-1])
    one, other = order[inner], order[inner + 1]
    is_broken = np.ones(len(one), bool)
    for turn in (1, 1j, -1, -1j):
        jumps = np.stack([first[one] - turn * first[other], second[one] - turn * second[other]], -1)
        broken = jumps - np.round(jumps.real) - 1j * np.round(jumps.imag)
        is_broken &= (np.abs(broken) > SAME).any(1) | (np.abs(jumps[:, 0] - jumps[:, 1]) > SAME)
    points = mesh_io.world_points(obj)
    lengths = np.linalg.norm(points[vertex[one]] - points[vertex[following[one]]], axis=1)
    return float(lengths[is_broken].sum() / np.linalg.norm(np.ptp(points, axis=0)))


def edges(obj, vertex, following):
    """(#C,) the edge from each corner to the following one, and whether it runs forward there. Where every face is
    apart, edges between the same places are one."""
    mesh = obj.data
    edge = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edge)
    if len(np.unique(edge)) < len(edge):
        return edge, vertex < vertex[following]
    place = np.unique(mesh_io.world_points(obj).round(6), axis=0, return_inverse=True)[1].ravel()[vertex]
    ends = np.sort(np.stack([place, place[following]], -1), axis=1)
    return np.unique(ends, axis=0, return_inverse=True)[1].ravel(), place < place[following]


def active_uv(obj):
    uv = np.empty(2 * len(obj.data.loops), np.float32)
    obj.data.uv_layers.active.data.foreach_get("uv", uv)
    return uv.reshape(-1, 2).astype(np.float64)


def measured(obj, uv=None):
    """Measures the UVs of the loops, by default the active ones."""
    uv = active_uv(obj) if uv is None else uv
    area, density, stretch = triangle_measures(obj, uv)
    low, median, high = quantiles(area, density, [0.05, 0.5, 0.95])
    return {
        "lost": float(area[density <= LOST * median].sum() / area.sum()),
        "95:5": float(high / low) if low > 0 else float("inf"),
        "s1/s2": float((area * stretch).sum() / area.sum()),
        "visible": visible_length(obj, uv),
    }


def is_no_worse(one, other):
    """Whether a map, as `measured`, loses no more than another, is even or hardly less so, hardly more sheared, and has
    no longer visible seams."""
    return (
        one["lost"] <= other["lost"] + LOST
        and one["95:5"] <= max(EVEN, HARDLY_LESS_EVEN * other["95:5"])
        and one["s1/s2"] <= max(UNSEEN_SHEAR, other["s1/s2"] + HARDLY_MORE_SHEARED)
        and one["visible"] <= HARDLY_LONGER * other["visible"]
    )


def in_edit_mode(*operators):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    for operator, options in operators:
        operator(**options)
    bpy.ops.object.mode_set(mode="OBJECT")


def choose(obj):
    for other in bpy.context.view_layer.objects:
        other.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj


def compare(obj, packages, only_button):
    choose(obj)
    row = {"object": obj.name, "faces": len(obj.data.polygons)}
    for name, operator in OURS.items():
        jobs.KEPT.clear()
        try:
            seconds, _ = timed(getattr(bpy.ops.uv, operator))
        except RuntimeError as error:
            return row | {"refused": " ".join(str(error).split())}
        row[name] = measured(obj) | {"seconds": seconds}
        if name == "button":
            row["verdict"] = json.loads(obj["holomorph_report"])["verdict"]["sentence"]
        if only_button:
            return row
    obj.data.uv_layers.active = obj.data.uv_layers.new(name="Smart UV Project")
    seconds, _ = timed(in_edit_mode, (bpy.ops.uv.smart_project, {}))
    in_edit_mode((bpy.ops.uv.seams_from_islands, {}))
    row["smart"] = measured(obj) | {"seconds": seconds}
    corners, vertices = triangles_of(obj)
    points, islands, uv = mesh_io.world_points(obj), active_uv(obj)[corners], active_uv(obj)
    for name, method in packages.items():
        seconds, made = timed(method, points, vertices, islands)
        uv[corners] = made.astype(np.float32)
        row[name] = measured(obj, uv) | {"seconds": seconds}
    known = {item.identifier for item in bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items}
    for method in [method for method in UNWRAPS if method in known]:
        seconds, _ = timed(in_edit_mode, (bpy.ops.uv.unwrap, {"method": method}))
        row[UNWRAPS[method]] = measured(obj) | {"seconds": seconds}
    others = [row[name] for name in OTHERS if name in row]
    row["no worse"] = all(is_no_worse(row["button"], other) for other in others)
    equal = [other["seconds"] for other in others if is_no_worse(other, row["button"])]
    row["faster"] = min(equal) / row["button"]["seconds"] if equal else None
    return row


def timed(work, *arguments, **options):
    """(Processor seconds of a call, what it returns)."""
    begin = time.process_time()
    made = work(*arguments, **options)
    return time.process_time() - begin, made


def objects_of(path):
    if path.suffix == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(path))
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        return [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH"]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.suffix.lower() not in (".obj", *native.load().files.formats.IMPORTERS):
        return [mesh_of(path)]
    with compatibility.old_numpy_names():
        compatibility.openers()[path.suffix.lower()](filepath=str(path))
    meshes = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and not gathering.is_helper(obj)]
    return sorted(meshes, key=lambda obj: obj.name)


def mesh_of(path):
    """The mesh of a file that the library reads, and Blender may not, such as PLY and OFF."""
    surface = native.load().Surface.read(str(path))
    mesh = mesh_io.new_mesh(path.stem, surface.vertices, surface.corner_vertices, surface.face_offsets)
    obj = bpy.data.objects.new(path.stem, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def irregular(faces):
    """A surface of genus 2 with about so many triangles, slivers among them, as isosurfaces have."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    vertices, triangles = meshes.double_torus(faces)
    offsets = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int32)
    mesh = mesh_io.new_mesh(f"genus 2, {faces}", vertices, triangles.ravel().astype(np.int32), offsets)
    obj = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def rows_of(path, packages, only_button):
    names = [obj.name for obj in objects_of(path)]
    return [compare(bpy.data.objects[name], packages, only_button) for name in names]


def lines(rows):
    heads = f"{'seconds':>8} {'lost':>7} {'95:5':>9} {'s1/s2':>7} {'visible':>8}"
    yield f"{'object':28} {'':15} {heads}  no worse  times faster than the fastest as good"
    for row in rows:
        if "refused" in row:
            yield f"{row['object']:28} refused: {row['refused']}"
        for name in (*OURS, *OTHERS):
            if name in row:
                of, end = row[name], ""
                numbers = f"{of['seconds']:8.2f} {of['lost']:7.2%} {of['95:5']:9.4g} {of['s1/s2']:7.4f}"
                numbers += f" {of['visible']:8.3f}"
                if name == "button":
                    faster = row.get("faster")
                    beside = f"{faster:.3g}" if faster else "none is as good"
                    end = f"  {'yes' if row.get('no worse') else 'NO'}  {beside}  {row['verdict']}"
                yield f"{row['object'] if name == 'button' else '':28} {name:15} {numbers}{end}"
    judged = [row["no worse"] for row in rows if "no worse" in row]
    yield f"{sum(judged)} of {len(judged)} objects: one click is no worse than the best of the others"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--faces", nargs="*", type=int, default=())
    parser.add_argument("--packages", type=Path, help="where xatlas, igl and SciPy are; Blender's own NumPy is kept")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--only-button", action="store_true")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    addon.register()
    if options.packages:
        sys.path.append(str(options.packages))
    how = {} if options.only_button else other_unwraps.known(), options.only_button
    rows = [row for path in options.files for row in rows_of(path, *how)]
    rows += [compare(irregular(faces), *how) for faces in options.faces]
    print("\n".join(lines(rows)))
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


main()
