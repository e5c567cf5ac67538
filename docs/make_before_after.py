# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures and figures of docs/tiling.md for one example: Blender's own maps, libigl's SLIM, Seamless Tiling.

python docs/make_before_after.py EXAMPLE.blend FOLDER TEXTURE TILES DIRECTION QUARTERS

In a Python with Blender as a module, 4.3 or later, and libigl. The object, camera and texture are the same in all
pictures, and so is the median size of the texture. Leaves EXAMPLE-KIND.png in FOLDER, for each kind of `made_maps`, and
prints a row of the table.
"""

import importlib.util
import json
import math
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import preview_scene

PACKAGE = "holomorph_pictures"
SAMPLES = 16
ISLAND_MARGIN = 0.01  # of Blender's packing, in UV units: no two islands touch
SMART_ANGLE = math.radians(66)  # Blender's default
MATCH = 1e-4  # in tiles: sides of an edge that differ from whole tiles by less show no seam
RESOLUTION = 420  # pixels
SLIM_STEPS = 50
DIAL = {"dial0": 1e-6, "tiling": 0.5, "dial1": 1.0}  # evenness; at 0 itself Automatic would place other poles
COMPARED = ("smart", "unwrap", "stretch", "slim", "tiling")  # columns of the table


def load_addon():
    folder = Path(__file__).resolve().parents[1] / "addon"
    spec = importlib.util.spec_from_file_location(
        PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE])
    sys.modules[PACKAGE].register()


def module(name):
    return importlib.import_module(f"{PACKAGE}.{name}")


def unwrapped(obj, name, operator, **options):
    """The UVs that one of Blender's own operators makes, in a map of that name."""
    obj.data.uv_layers.active = obj.data.uv_layers.new(name=name)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    operator(**options)
    bpy.ops.object.mode_set(mode="OBJECT")
    return module("scene.uv_maps").read_map(obj.data, name)


def median_density(points, polygons, uv):
    """The median of UV area per surface area, by surface area."""
    corners, _ = module("native").load().distortion.fans(polygons.face_offsets)
    area, uv_area = areas(points[polygons.corner_vertices[corners]]), areas(uv[corners])
    order = np.argsort(uv_area / area)
    total = np.cumsum(area[order])
    return (uv_area / area)[order[np.searchsorted(total, total[-1] / 2)]]


def areas(triangles):
    """Areas of (#T, 3, d) triangles in the plane or in space."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    aa, ab, bb = (np.einsum("ij,ij->i", x, y) for x, y in ((a, a), (a, b), (b, b)))
    return np.sqrt(np.clip(aa * bb - ab * ab, 0, None)) / 2


def breaks(points, polygons, uv):
    """(islands, length of the edges where the texture does not continue over the size of the object)."""
    start, count = polygons.face_offsets, len(polygons.corner_vertices)
    face = np.repeat(np.arange(len(start) - 1), np.diff(start))
    following = np.where(np.arange(count) + 1 == start[face + 1], start[face], np.arange(count) + 1)
    ends = np.stack([polygons.corner_vertices, polygons.corner_vertices[following]])
    edge = ends.min(axis=0).astype(np.int64) * len(points) + ends.max(axis=0)
    order = np.argsort(edge, kind="stable")
    inner = np.flatnonzero(edge[order][:-1] == edge[order][1:])
    one, other = order[inner], order[inner + 1]
    jumps = np.stack([uv[one] - uv[following[other]], uv[following[one]] - uv[other]])
    joined = np.abs(jumps).max(axis=(0, 2)) < MATCH
    torn = np.abs(jumps - np.rint(jumps)).max(axis=(0, 2)) >= MATCH
    torn |= np.abs(np.rint(jumps[0]) - np.rint(jumps[1])).max(axis=1) > 0
    lengths = np.linalg.norm(points[ends[0][one]] - points[ends[1][one]], axis=1)
    size = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    return part_count(len(start) - 1, face[one[joined]], face[other[joined]]), lengths[torn].sum() / size


def part_count(count, first, second):
    """Connected parts of a graph: every node takes the least label around it until none changes."""
    label = np.arange(count)
    while True:
        old = label.copy()
        least = np.minimum(label[first], label[second])
        np.minimum.at(label, first, least)
        np.minimum.at(label, second, least)
        label = label[label]
        if np.array_equal(label, old):
            return len(np.unique(label))


def figures(points, polygons, uv):
    """(size range, islands, length of visible seams)"""
    corners, offsets = polygons.corner_vertices, polygons.face_offsets
    mesh = SimpleNamespace(vertices=points, corner_vertices=corners, face_offsets=offsets)
    found = module("native").load().distortion.measure(mesh, uv)
    return found.size_range, *breaks(points, polygons, uv)


def slim(obj, points, polygons, stretch):
    """Further steps of SLIM from the UVs of Minimum Stretch, which is SLIM, too: libigl's on the same seams."""
    import igl

    holomorph = module("native").load()
    corners, _ = holomorph.distortion.fans(polygons.face_offsets)
    surface = holomorph.Surface(points, polygons.corner_vertices[corners])
    ends, is_seam = np.empty(2 * len(obj.data.edges), np.int32), np.empty(len(obj.data.edges), bool)
    obj.data.edges.foreach_get("vertices", ends)
    obj.data.edges.foreach_get("use_seam", is_seam)
    own, seams = (
        np.sort(e, axis=1).astype(np.int64) @ [len(points), 1] for e in (surface._native.edges, ends.reshape(-1, 2))
    )
    cut = importlib.import_module("holomorph.mesh.surgery").cut_open(surface, np.isin(own, seams[is_seam]))
    none = np.zeros(0, np.int32), np.zeros((0, 2), order="F")
    mesh = np.asfortranarray(cut.vertices), np.asfortranarray(cut.triangles, np.int32)
    start = np.empty((len(cut.vertices), 2), order="F")
    start[cut.triangles] = stretch[corners]
    data = igl.slim_precompute(*mesh, start, igl.MappingEnergyType.SYMMETRIC_DIRICHLET, *none, 0.0)
    uv = np.empty((len(polygons.corner_vertices), 2))
    uv[corners] = igl.slim_solve(data, SLIM_STEPS)[cut.triangles]
    return uv


def made_maps(obj, points, polygons, **options):
    """The UVs of each way. Those that need seams get the cut of ours, for the examples have none."""
    uv_maps = module("scene.uv_maps")
    smart = {"angle_limit": SMART_ANGLE, "island_margin": ISLAND_MARGIN}
    maps = {"smart": unwrapped(obj, "smart", bpy.ops.uv.smart_project, **smart)}
    for kind, evenness in DIAL.items():
        bpy.ops.uv.holomorphic_tile(seams=kind == "tiling", evenness=evenness, turns="NONE", **options)
        maps[kind] = uv_maps.read_map(obj.data, uv_maps.MAIN_MAP)
    for kind, method in ("unwrap", "ANGLE_BASED"), ("stretch", "MINIMUM_STRETCH"):
        maps[kind] = unwrapped(obj, kind, bpy.ops.uv.unwrap, method=method, margin=ISLAND_MARGIN)
    maps["slim"] = slim(obj, points, polygons, maps["stretch"])
    return maps


def show(obj, polygons, uv):
    """In the map that the material shows."""
    uv_maps = module("scene.uv_maps")
    uv_maps.overwrite_map(obj.data, polygons, uv_maps.MAIN_MAP, uv.astype(np.float32))
    obj.data.update()


def row(name, parts, found):
    """A row of the table in docs/tiling.md: poles, islands of Smart UV, then size ranges and seams of all maps."""
    poles = sum(len(part["tiling"]["poles"]) for part in parts)
    sizes, islands, seams = zip(*(found[kind] for kind in COMPARED))
    cells = [f"{size:.2f}" for size in sizes] + [f"{length:.1f}" for length in seams]
    return f"| {name} | {poles} | {islands[0]} | {' | '.join(cells)} |"


def main():
    path, folder, texture, tiles, direction, quarters = sys.argv[1:]
    bpy.ops.wm.open_mainfile(filepath=path)
    load_addon()
    obj, name = bpy.context.view_layer.objects.active, Path(path).stem
    points = module("scene.mesh_io").world_points(obj)
    polygons = module("scene.mesh_io").read_polygons(obj.data, np.eye(3))
    options = dict(texture=texture, tiles=int(tiles), direction=direction, quarters=int(quarters))
    maps = made_maps(obj, points, polygons, **options)
    median = median_density(points, polygons, maps["tiling"])
    found = {}
    for kind, uv in maps.items():
        uv = uv.astype(np.float64) * math.sqrt(median / median_density(points, polygons, uv.astype(np.float64)))
        found[kind] = figures(points, polygons, uv)
        show(obj, polygons, uv)
        preview_scene.render([obj], f"{folder}/{name}-{kind}.png", RESOLUTION, SAMPLES)
    print(row(name, json.loads(obj[module("results.report").PROPERTY])["components"], found))
    print("dial:", name, ", ".join(f"{found[kind][0]:.1f} at {evenness}" for kind, evenness in DIAL.items()))


main()
