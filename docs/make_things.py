# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/things.md: scales, bricks and wires on examples, by their tilings.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/make_things.py -- PNG KIND TILES

KIND is scales, bricks or wires.
"""

import importlib
import importlib.util
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import preview_scene

PACKAGE = "holomorph_pictures"
SAMPLES, RESOLUTION = 32, 480
LEAST, MOST = 0.3, 1.3  # of the median size: smaller scales, near poles, are left out, and none is larger
COLOURS = {"scales": (0.05, 0.28, 0.13), "bricks": (0.35, 0.16, 0.08), "wires": (0.55, 0.36, 0.13)}
GROUND = (0.02, 0.02, 0.02)


def module(name):
    return importlib.import_module(f"{PACKAGE}.{name}")


def load_addon():
    folder = Path(__file__).resolve().parents[1] / "addon"
    spec = importlib.util.spec_from_file_location(
        PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE])


def smooth_normals(surface):
    """(#V, 3) unit vectors."""
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    normals = np.zeros_like(surface.vertices)
    np.add.at(normals, surface.triangles.T, np.cross(b - a, c - a))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def scale(columns=9, rows=9):
    """(k, 3) points along u, v and the normal in tiles, and quads of them: a scale that hangs down."""
    s, t = np.meshgrid(np.linspace(-1, 1, columns), np.linspace(0, 1, rows))
    width = 0.53 * np.sqrt(1 - 0.97 * t**3)
    points = np.stack([s * width, 0.45 - 1.05 * t, 0.02 + 0.2 * t - 0.1 * s * s], axis=-1)
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    return points.reshape(-1, 3), np.stack([first, first + columns, first + columns + 1, first + 1], axis=1)


def scales(tiled):
    """Two rows of scales in each tile, shifted: a copy of one on each place."""
    places = tiled.places(per_tile=(2, 4), offset=(0.5, 0.5), shifted_rows=True)
    relative = places.sizes / np.median(places.sizes)
    normals = places.of(smooth_normals(tiled.surface)) * places.sizes[:, None]
    frames = np.concatenate([places.tangents, normals[:, None]], axis=1) / 2
    frames *= np.minimum(1, MOST / relative)[:, None, None]
    points, quads = scale()
    copies = (places.positions[:, None] + points @ frames)[relative > LEAST]
    faces = quads + len(points) * np.arange(len(copies))[:, None, None]
    return copies.reshape(-1, 3), faces.ravel(), 4 * np.arange(faces.shape[0] * faces.shape[1] + 1)


def bricks(tiled):
    """Each cell a little smaller and raised, with sides."""
    cells = tiled.cells(per_tile=(1, 2), shifted_rows=True)
    sizes = np.diff(cells.face_offsets)
    corners = cells.corner_vertices
    faces = np.repeat(np.arange(len(cells)), sizes)
    points, normals = cells.vertices[corners], cells.of(smooth_normals(tiled.surface))[corners]
    middle = np.add.reduceat(points, cells.face_offsets[:-1]) / sizes[:, None]
    radius = np.sqrt(np.add.reduceat(((points - middle[faces]) ** 2).sum(axis=1), cells.face_offsets[:-1]) / sizes)
    inner = points + 0.1 * (middle[faces] - points)
    top = inner + 0.45 * np.minimum(radius, 1.5 * np.median(radius))[faces][:, None] * normals
    count = len(points)
    following = cells._following
    sides = np.stack([np.arange(count), following, following + count, np.arange(count) + count], axis=1)
    offsets = np.concatenate([cells.face_offsets, cells.face_offsets[-1] + 4 * np.arange(1, count + 1)])
    return np.concatenate([inner, top]), np.concatenate([np.arange(count) + count, sides.ravel()]), offsets


def wires(tiled):
    """Both families of lines as tubes: of Blender's own curves."""
    curve = bpy.data.curves.new("Wires", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.07 * float(np.median(tiled.places().sizes))
    for lines in (tiled.lines("u", 2), tiled.lines("v", 2)):
        for points, is_closed in zip(np.split(lines.positions, lines.offsets[1:-1]), lines.is_closed):
            spline = curve.splines.new("POLY")
            spline.points.add(len(points) - 1)
            spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).ravel())
            spline.use_cyclic_u = bool(is_closed)
    made = bpy.data.objects.new("Wires", curve)
    mesh = bpy.data.meshes.new_from_object(made)
    polygons = module("scene.mesh_io").read_polygons(mesh, np.eye(3))
    return polygons.vertices, polygons.corner_vertices, polygons.face_offsets


def coloured(obj, colour):
    material = bpy.data.materials.new("Colour")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = 0.4
    obj.data.materials.clear()
    obj.data.materials.append(material)
    return obj


def main():
    png, kind, tiles = sys.argv[sys.argv.index("--") + 1 :]
    load_addon()
    holomorph, mesh_io = module("native").load(), module("scene.mesh_io")
    body = bpy.context.view_layer.objects.active
    polygons = mesh_io.read_polygons(body.data, np.eye(3))
    surface = holomorph.Surface.from_polygons(
        mesh_io.world_points(body), polygons.corner_vertices, polygons.face_offsets, strict=False
    )
    tiled = holomorph.automatic_map(surface.components[0], main="seamless", tiles=float(tiles)).tiled
    vertices, corners, offsets = {"scales": scales, "bricks": bricks, "wires": wires}[kind](tiled)
    mesh = mesh_io.new_mesh(kind, vertices, corners.astype(np.int32), offsets.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), kind != "bricks"))
    things = coloured(bpy.data.objects.new(kind, mesh), COLOURS[kind])
    shown = [things] if kind == "wires" else [coloured(body, GROUND), things]
    preview_scene.render(shown, png, RESOLUTION, SAMPLES)


main()
