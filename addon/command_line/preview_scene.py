# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of objects in a photo studio: in a scene of its own, so that the user's stays as it is."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..scene import mesh_io

VIEW = Vector((0.62, -1.0, 0.55))  # from the object towards the camera: three quarters, from above
LENS = 70.0  # millimetres, on a 36 mm sensor
MARGIN = 1.12  # how much wider than the object the picture is
BACKGROUND = (0.80, 0.81, 0.82)  # linear RGB
FLOOR_GAP = 1e-3  # share of the object's size: the floor does not intersect the object


def render(objects, path, resolution, samples):
    """Renders `objects` with Cycles on the CPU into a square PNG at `path`."""
    scene = bpy.data.scenes.new("Holomorph Studio")
    for obj in objects:
        scene.collection.objects.link(obj)
    points = np.concatenate([mesh_io.world_points(o) for o in objects])
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
    mesh = mesh_io.new_mesh("Studio Floor", np.array(corners), np.arange(4), np.array([0, 4]))
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
