# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map over the faces of meshes in the 3D view, and its legend. Called from draw handlers only.

A batch is made when an object is first drawn, and kept until `forget`: meshes do not change between two redraws.
"""

from dataclasses import dataclass

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix

from ..native import holomorph
from ..results import heat
from . import on_screen


@dataclass(frozen=True)
class Scale:
    """The colours of a quantity along a bar, and what is written beside them."""

    stops: tuple  # sRGB, evenly along the bar
    ticks: tuple  # (place, text)

    def colours(self, places):
        """(n, 3) float32 sRGB at places on the bar; places beyond its ends are moved there."""
        at = np.linspace(0, 1, len(self.stops))
        return np.stack([np.interp(places, at, channel) for channel in np.transpose(self.stops)], -1).astype(np.float32)


OCTAVES_SHOWN = 4.0  # on either side of the median

DENSITY = Scale(
    ((0.13, 0.27, 0.60), (0.40, 0.62, 0.80), (0.90, 0.89, 0.86), (0.93, 0.60, 0.36), (0.66, 0.13, 0.14)),
    ((0.0, "1/16"), (0.25, "1/4"), (0.5, "median"), (0.75, "4"), (1.0, "16")),
)
ANGLE = Scale(
    ((0.90, 0.89, 0.86), (0.95, 0.80, 0.45), (0.91, 0.47, 0.28), (0.68, 0.16, 0.35), (0.28, 0.05, 0.33)),
    ((0.0, "1"), (0.316, "1.1"), (0.548, "1.3"), (0.775, "1.6"), (1.0, "2")),
)
DIRECTION = Scale(
    ((0.90, 0.89, 0.86), (0.95, 0.80, 0.45), (0.91, 0.47, 0.28), (0.58, 0.22, 0.48), (0.13, 0.27, 0.60)),
    ((0.0, "upright"), (0.25, "45"), (0.5, "sideways"), (0.75, "135"), (1.0, "upside down")),
)


def density_places(octaves):
    return 0.5 + octaves / (2 * OCTAVES_SHOWN)


def angle_places(angle):
    """Places on the bar of s1 / s2. The root shows small distortions well: most are small."""
    return np.sqrt(np.clip(angle - 1, 0, 1))


BAR_WIDTH, BAR_HEIGHT = 280, 12  # pixels, in a user interface of normal size
BAR_ABOVE = 52  # pixels, from the lower edge of the view
DEPTH_BIAS = (
    1e-6  # part of the depth from -1 to 1: ten steps of a depth buffer, to lie over the faces as the mesh has them
)
LIGHT = np.array((0.35, -0.45, 0.82), np.float32)  # direction to the light
SHADE = 0.45  # how much darker a face is that is turned away from it

_kept = {}  # object name: `_View`


@dataclass(frozen=True)
class _View:
    """An object's faces, with modifiers, as they are drawn."""

    key: tuple  # what must be the same for the batch to be drawn again
    batch: object
    map_name: str
    found: object  # `holomorph.distortion.Distortion`


def forget():
    _kept.clear()


def draw(context, objects, quantity):
    depsgraph = context.evaluated_depsgraph_get()
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    views = [(o, _view(o, depsgraph, quantity, shader)) for o in objects]
    bias = Matrix.Identity(4)
    bias[2][3] = -DEPTH_BIAS
    gpu.state.depth_test_set("LESS_EQUAL")
    with gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(bias @ gpu.matrix.get_projection_matrix())
        for obj, view in views:
            if view is not None:
                with gpu.matrix.push_pop():
                    gpu.matrix.translate(obj.matrix_world.translation)
                    view.batch.draw(shader)
    gpu.state.depth_test_set("NONE")


def _view(obj, depsgraph, quantity, shader):
    """The kept view of an object or a new one; None without a UV map."""
    linear = obj.matrix_world.to_3x3()
    key = quantity, tuple(map(tuple, linear))
    known = _kept.get(obj.name)
    if known is not None and known.key == key:
        return known
    mesh = obj.evaluated_get(depsgraph).data
    if mesh.uv_layers.active is None or not len(mesh.polygons):
        return None
    polygons, found = heat.measured(mesh, linear)
    points, colours = lit_triangles(polygons, *places_and_scale(found, quantity))
    batch = batch_for_shader(shader, "TRIS", {"pos": points, "color": colours})
    _kept[obj.name] = _View(key, batch, mesh.uv_layers.active.name, found)
    return _kept[obj.name]


def places_and_scale(found, quantity):
    """((#F,) places on the bar, the `Scale`)."""
    if quantity == "DENSITY":
        return density_places(found.density), DENSITY
    if quantity == "DIRECTION":
        return found.direction / 180, DIRECTION
    return angle_places(found.angle), ANGLE


def lit_triangles(polygons, places, scale):
    """((3 #T, 3) positions, (3 #T, 4) colours): flat colours, a little darker away from the light."""
    corners, polygon = holomorph.distortion.fans(polygons.face_offsets)
    points = polygons.vertices[polygons.corner_vertices[corners]].astype(np.float32)
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    towards = normals @ LIGHT / np.where(lengths > 0, lengths, 1)
    colours = np.ones((len(points), 4), np.float32)
    colours[:, :3] = scale.colours(places)[polygon] * (1 - SHADE * (0.5 - 0.5 * towards))[:, None]
    return points.reshape(-1, 3), np.repeat(colours, 3, axis=0)


def draw_legend(context, objects, quantity):
    view = _kept.get(objects[0].name)
    if view is None:
        return
    unit = context.preferences.system.ui_scale
    _, scale = places_and_scale(view.found, quantity)
    width, left, low = BAR_WIDTH * unit, context.region.width / 2 - BAR_WIDTH * unit / 2, BAR_ABOVE * unit
    gpu.state.blend_set("ALPHA")
    on_screen.rectangle(left - 24 * unit, low - 24 * unit, width + 48 * unit, 60 * unit, [on_screen.BACKGROUND] * 2)
    step = width / (len(scale.stops) - 1)
    for index, pair in enumerate(zip(scale.stops, scale.stops[1:])):
        on_screen.rectangle(left + index * step, low, step, BAR_HEIGHT * unit, [(*colour, 1.0) for colour in pair])
    gpu.state.blend_set("NONE")
    for place, text in scale.ticks:
        on_screen.text(text, left + place * width, low - 16 * unit, unit)
    on_screen.text(_title(view, quantity), left + width / 2, low + 20 * unit, unit)


def _title(view, quantity):
    if quantity == "DENSITY":
        return f"{view.map_name}: density of the texture, size range {view.found.size_text}"
    if quantity == "DIRECTION":
        return f"{view.map_name}: {100 * view.found.upright_part:.0f} % of the steep faces upright"
    return f"{view.map_name}: angle distortion {view.found.mean_angle:.4f}"
