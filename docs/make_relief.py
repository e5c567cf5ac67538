# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a relief: scripts/relief-picture puts several together.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/make_relief.py -- \
    PICTURE PATTERN TILES DEPTH [projected]

PATTERN : "knurls", or one of the add-on's textures; DEPTH : in sides of a tile. With "projected" the same heights are
raised by projections along the three axes instead, blended by the normals, as slicers do it.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import preview_scene

import addon
from addon import compatibility
from addon.materials.patterns import TEXTURES
from addon.scene import image_io, mesh_io
from addon.things import geometry

RESOLUTION, SAMPLES = 520, 24
PIXELS = 256
TRIANGLES = 700_000
SHARPNESS = 6.0  # of the blend of three projections: a power of the normal's components
CLAY = (0.50, 0.27, 0.17)  # linear RGB


def knurls(size):
    """Pyramids in diagonal rows."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    ridges = [np.abs(2 * ((k * x + y) % 1) - 1) for k in (1, -1)]
    return np.clip(1.6 * np.minimum(*ridges) ** 0.8, 0, 1)


def heights(pattern):
    """(h, w), the lowest row first."""
    if pattern == "KNURLS":
        return knurls(PIXELS)
    drawn = TEXTURES[pattern].draw(4 * PIXELS).height
    return drawn.reshape(PIXELS, 4, PIXELS, 4).mean(axis=(1, 3))


def image_of(values):
    image = bpy.data.images.new("Heights", PIXELS, PIXELS, float_buffer=True)
    image_io.write_pixels(image, np.repeat(values[..., None], 4, axis=2))
    return image


def projected(obj, values, side, depth):
    """An object like `obj`, fine everywhere, raised by projections."""
    library = addon.native.load()
    polygons = mesh_io.read(obj)
    vertices, triangles = _fine(polygons.surface(strict=False))
    surface = library.Surface(vertices, triangles)
    normals = library.tiles.relief.normals(surface)[0]
    weights = np.abs(normals) ** SHARPNESS
    weights /= weights.sum(axis=1, keepdims=True)
    height = sum(weights[:, k] * _sampled(values, vertices[:, [k - 2, k - 1]] / side) for k in range(3))
    moved, offsets = vertices + depth * height[:, None] * normals, 3 * np.arange(len(triangles) + 1)
    made = mesh_io.new_mesh("Projected", moved, triangles.ravel(), offsets)
    raised = bpy.data.objects.new("Projected", made)
    raised.location = obj.matrix_world.translation
    return raised


def _fine(surface):
    """Triangles cut into four until there are as many as in a relief."""
    vertices, triangles = surface.vertices, surface.triangles.astype(np.int64)
    while 4 * len(triangles) < 2 * TRIANGLES:
        sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, middle = np.unique(sides, axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = triangles.T, middle.reshape(-1, 3).T + len(vertices)
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1)])
        triangles = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return vertices, triangles


def _sampled(values, at):
    """Bilinear between the middles of pixels, which repeat."""
    place = at * len(values) - 0.5
    low = np.floor(place).astype(int)
    x, y = (place - low).T
    (j, i), count = low.T, len(values)
    rows = [(1 - x) * values[(i + d) % count, j % count] + x * values[(i + d) % count, (j + 1) % count] for d in (0, 1)]
    return (1 - y) * rows[0] + y * rows[1]


def paint(obj):
    made = bpy.data.materials.new("Clay")
    compatibility.enable_nodes(made)
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*CLAY, 1.0)
    shader.inputs["Roughness"].default_value = 0.45
    obj.data.materials.clear()
    obj.data.materials.append(made)


def main():
    path, pattern, tiles, depth, *kind = sys.argv[sys.argv.index("--") + 1 :]
    addon.register()
    obj = bpy.context.view_layer.objects.active
    bpy.ops.uv.holomorphic_tile(tiles=int(tiles), checker=False)
    bpy.context.scene.unit_settings.system = "NONE"
    values = heights(pattern.upper())
    polygons = geometry.source(obj)[0]
    side = (polygons.surface(strict=False).area / int(tiles)) ** 0.5
    if kind == ["projected"]:
        made = projected(obj, values, side, float(depth) * side)
    else:
        bpy.ops.object.holomorphic_relief(
            image=image_of(values).name, depth=float(depth) * side, most_triangles=TRIANGLES
        )
        made = bpy.data.objects[f"{obj.name} Relief"]
    paint(made)
    preview_scene.render([made], path, RESOLUTION, SAMPLES)


main()
