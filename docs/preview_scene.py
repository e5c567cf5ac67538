# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of objects in a photo studio: in a scene of its own, so that the user's stays as it is.

blender -b FILE.blend --factory-startup --python-exit-code 1 --python docs/preview_scene.py -- PNG [RESOLUTION]

This takes one of all mesh objects that are seen.
"""

import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

VIEW = Vector((0.62, -1.0, 0.55))  # from the object towards the camera: three quarters, from above
LENS = 70.0  # millimetres, on a 36 mm sensor
MARGIN = 1.12  # how much wider than the object the picture is
BACKGROUND = (0.80, 0.81, 0.82)  # linear RGB
SAMPLES = 24  # of each pixel
FLOOR_GAP = 1e-3  # share of the object's size: the floor does not intersect the object


def render(objects, path, resolution, samples):
    """Renders `objects` with Cycles on the CPU into a square PNG at `path`."""
    scene = bpy.data.scenes.new("Holomorph Studio")
    for obj in objects:
        scene.collection.objects.link(obj)
    points = np.concatenate([_world_points(o) for o in objects])
    low, high = points.min(axis=0), points.max(axis=0)
    centre, size = Vector((low + high) / 2), max(float(np.linalg.norm(high - low)), 1e-6)
    scene.camera = _camera(scene, points)
    _floor(scene, centre, float(low[2]) - FLOOR_GAP * size, size)
    for name, direction, width, power in (
        ("Key", (-0.9, -1.0, 1.5), 1.1, 19.0),
        ("Fill", (1.4, -0.7, 0.5), 1.6, 5.0),
        ("Rim", (0.4, 1.4, 1.1), 0.9, 12.0),
    ):
        _light(scene, name, centre, Vector(direction).normalized(), size, width, power)
    scene.world = _world()
    _settings(scene, path, resolution, samples)
    bpy.ops.render.render(write_still=True, scene=scene.name)


def _world_points(obj):
    """(#V, 3) positions in the world."""
    points = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", points)
    matrix = np.array(obj.matrix_world, np.float64)
    return points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def _looking(direction):
    """The rotation of a camera or lamp that looks against `direction`, upright."""
    return direction.to_track_quat("Z", "Y").to_matrix()


def _camera(scene, points):
    """The nearest camera on the line of sight that sees every point, framed tightly.

    With t the tangent of half the angle, a point (x, y, z) of camera axes is seen from (cx, cy, d) if
    |x - cx| <= t (d - z), and for y. For x this is cx >= max(x + t z) - t d and cx <= t d - max(-x + t z),
    so d >= (max(x + t z) + max(-x + t z)) / (2 t), and cx is then in the middle.
    """
    data = bpy.data.cameras.new("Studio")
    data.lens = LENS
    rotation = _looking(VIEW.normalized())
    tangent = data.sensor_width / 2 / LENS / MARGIN
    local = points @ np.array(rotation)
    x, y, z = local.T
    right, left = np.max(x + tangent * z), np.max(-x + tangent * z)
    up, down = np.max(y + tangent * z), np.max(-y + tangent * z)
    distance = max(right + left, up + down) / (2 * tangent)
    position = rotation @ Vector(((right - left) / 2, (up - down) / 2, distance))
    depth = max(distance - float(z.min()), 1e-6)
    data.clip_start, data.clip_end = depth * 1e-3, depth * 1e3
    return _place(scene, data, Matrix.Translation(position) @ rotation.to_4x4())


def _place(scene, data, matrix):
    obj = bpy.data.objects.new(data.name, data)
    obj.matrix_world = matrix
    scene.collection.objects.link(obj)
    return obj


def _light(scene, name, centre, direction, size, width, power):
    """An area light that throws the same light on an object of any size: power grows with the area."""
    data = bpy.data.lights.new(f"Studio {name}", "AREA")
    data.size = width * size
    data.energy = power * size * size
    position = centre + direction * (1.6 * size)
    _place(scene, data, Matrix.Translation(position) @ _looking(direction).to_4x4())


def _floor(scene, centre, height, size):
    """A plane that shows nothing but the object's shadow."""
    half = 40 * size
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    mesh = bpy.data.meshes.new("Studio Floor")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    obj = _place(scene, mesh, Matrix.Translation((centre.x, centre.y, height)))
    obj.is_shadow_catcher = True


def _world():
    """Light grey all around, as seen and as light."""
    world = bpy.data.worlds.new("Studio")
    world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    background.inputs[0].default_value = (*BACKGROUND, 1.0)
    background.inputs[1].default_value = 1.0
    return world


def _settings(scene, path, resolution, samples):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 4
    scene.render.resolution_x = scene.render.resolution_y = resolution
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = path
    scene.render.use_file_extension = False  # the name as it was given
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"


def main(path, resolution="800"):
    objects = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and obj.visible_get()]
    render(objects, path, int(resolution), SAMPLES)


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
