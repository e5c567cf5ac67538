# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of an image of one's own on a model: scripts/own-picture puts several together.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/make_own.py -- \
    PICTURE bricks|hexagons SIZE [smart]

With "smart" the same image lies on Blender's Smart UV Project instead, with the same median size.
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import preview_scene

import addon
from addon import native
from addon.materials.periodic import mix, smoothstep
from addon.scene import image_io, mesh_io, uv_maps

RESOLUTION, SAMPLES = 560, 32
MAP = uv_maps.MAIN_MAP


def places(height, width, rows, columns):
    """y and x of the pixels' middles, in rows and columns."""
    y, x = np.indices((height, width)) + 0.5
    return y * rows / height, x * columns / width


def bricks():
    """Four courses of four, each with a stud: an image twice as wide as high."""
    y, x = places(256, 512, 4, 4)
    x = x + 0.5 * np.floor(y)
    edge = np.minimum(2 * np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1))
    stud = smoothstep(0.24, 0.20, np.hypot(2 * (x % 1 - 0.3), y % 1 - 0.5))
    brick = mix((0.62, 0.22, 0.13), (0.92, 0.75, 0.35), stud)
    return mix((0.8, 0.78, 0.72), brick, smoothstep(0.06, 0.12, edge))


def hexagons():
    """Two, in an image 1.73 times as high as wide."""
    y, x = places(444, 256, 2, 1)
    inside, near = np.zeros(y.shape), np.full(y.shape, np.inf)
    for row in (np.round(y) + k for k in (-1, 0, 1)):
        dx, dy = (x - row / 2 + 0.5) % 1 - 0.5, (y - row) * math.sqrt(0.75)
        edge = 0.5 - np.maximum(np.abs(dx), 0.5 * np.abs(dx) + math.sqrt(0.75) * np.abs(dy))
        distance = np.hypot(dx, dy)
        inside, near = np.where(distance < near, edge, inside), np.minimum(distance, near)
    plate = mix((0.1, 0.35, 0.45), (0.9, 0.85, 0.6), smoothstep(0.2, 0.17, near))
    return mix((0.85, 0.83, 0.8), plate, smoothstep(0.04, 0.07, inside))


def image(colour):
    made = bpy.data.images.new("Own", colour.shape[1], colour.shape[0])
    image_io.write_pixels(made, np.dstack([colour, np.ones(colour.shape[:2])]))
    made.pack()
    return made


def project(obj, size):
    """Smart UV in place of the map, with the same width of an image."""
    obj.data.uv_layers.active = obj.data.uv_layers[MAP]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(correct_aspect=False)  # our material itself shows the image as high as it is
    bpy.ops.object.mode_set(mode="OBJECT")
    polygons = mesh_io.read(obj)
    uv = uv_maps.read_corners(obj.data, polygons, MAP)
    factor = 1 / (size * native.load().distortion.length_ratio(polygons, uv))
    uv_maps.overwrite_map(obj.data, polygons, MAP, (factor * uv).astype(np.float32))


def main():
    path, name, size, *kind = sys.argv[sys.argv.index("--") + 1 :]
    addon.register()
    obj, own = bpy.context.view_layer.objects.active, image({"bricks": bricks, "hexagons": hexagons}[name]())
    bpy.ops.uv.holomorphic_tile(texture="IMAGE", source=own.name, size=float(size))
    if kind == ["smart"]:
        project(obj, float(size))
    preview_scene.render([obj], path, RESOLUTION, SAMPLES)


main()
