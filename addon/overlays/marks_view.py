# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of tilings as dots in the 3D view: poles or cones, and branch points, which follow. Called from draw handlers
only.

A dot is a disc in space that faces the viewer and has the same size on the screen at every distance.
"""

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..results import report
from ..results.report import CONE, POLE, ZERO
from ..scene import mesh_io, stored_dials
from . import on_screen

NAMES = ("point", "points"), ("that follows", "that follow"), ("point", "points")  # one, several
COLOURS = np.array([(1.0, 0.55, 0.10), (0.95, 0.95, 0.95), (0.45, 0.85, 1.0)])  # sRGB
SIZES = np.array([1.0, 1.0, 0.6])  # there are more cones, and less is to be seen at each
LIT = (1.0, 0.85, 0.25)
HOVERED = 1.5  # times as large is the pole under the pointer
RIM = (0.05, 0.05, 0.05)
RADIUS, RIM_WIDTH = 6.0, 1.5  # pixels, in a user interface of normal size
CORNERS = 20  # of a disc
HIDDEN = 0.25  # opacity behind something
# Pixels of the legend's first dot, from the middle of the view's lower edge: the corners have panels, and above is the
# heat map's legend.
LEGEND = (-90.0, 14.0)
GAP = 12.0  # pixels between a dot and its words, and half of what is between these and the next dot
NEARER = 2.0  # radii by which a disc is moved towards the viewer: the faces around its vertex must not cut it


def draw(context, objects, dragged):
    """`dragged`: see `overlay.dragged`."""
    points, kinds, is_hovered = _all_points(objects, dragged)
    if not len(points):
        return
    view = context.region_data
    unit = context.preferences.system.ui_scale
    radii = RADIUS * unit * pixel_sizes(points, view, context.region.height)
    radii *= SIZES[kinds] * np.where(is_hovered, HOVERED, 1)
    axes = np.array(view.view_matrix.inverted())
    towards = axes[:3, 3] - points if view.is_perspective else np.tile(axes[:3, 2], (len(points), 1))
    towards = radii[:, None] * towards / np.linalg.norm(towards, axis=1, keepdims=True)
    colours = np.where(is_hovered[:, None], LIT, COLOURS[kinds])
    colours = np.repeat(colours, 3 * CORNERS, axis=0)
    dots = discs(points + NEARER * towards, radii, axes[:3, :2].T)
    rims = discs(points + NEARER * towards, (1 + RIM_WIDTH / RADIUS) * radii, axes[:3, :2].T)
    gpu.state.depth_mask_set(False)  # a disc is drawn over its rim, and hidden or not by the meshes alone
    gpu.state.blend_set("ALPHA")
    for test, opacity in (("GREATER", HIDDEN), ("LESS_EQUAL", 1.0)):
        _draw_discs(rims, RIM, opacity, test)
        _draw_discs(dots, colours, opacity, test)
    gpu.state.blend_set("NONE")
    gpu.state.depth_test_set("NONE")
    gpu.state.depth_mask_set(True)


def draw_legend(context, objects, dragged):
    """What the dots are, and how many there are of each kind."""
    _, kinds, _ = _all_points(objects, dragged)
    unit = context.preferences.system.ui_scale
    x, y = context.region.width / 2 + LEGEND[0] * unit, LEGEND[1] * unit
    for words, colour in legend(kinds):
        middle, flat = np.array([[x, y, 0.0]]), np.eye(3)[:2]
        for radius, fill in ((RADIUS + RIM_WIDTH, RIM), (RADIUS, colour)):
            _draw_discs(discs(middle, np.array([radius * unit]), flat), fill, 1.0, "NONE")
        on_screen.text_from(words, x + GAP * unit, y - on_screen.TEXT_SIZE * unit / 3, unit)
        x += on_screen.text_width(words, unit) + 3 * GAP * unit


def legend(kinds):
    """(how many, in words, colour) of each kind of dot that there is."""
    counts = np.bincount(kinds, minlength=len(NAMES)).tolist()
    words = (f"{count} {names[count != 1]}" for count, names in zip(counts, NAMES))
    return [each for count, *each in zip(counts, words, map(tuple, COLOURS)) if count]


def _all_points(objects, dragged):
    """The `_points` of all objects together."""
    found = [_points(obj, dragged.get(obj.name)) for obj in objects if stored_dials.made(obj)]
    nothing = np.empty((0, 3)), np.empty(0, np.int64), np.empty(0, bool)
    return tuple(np.concatenate(parts) for parts in zip(nothing, *found))


def _points(obj, dragged):
    """The marks of an object with a map: (n, 3) places in the world, (n,) kinds, (n,) whether the pointer is on it."""
    vertices, kinds = report.points(obj)
    if dragged is not None:  # these first, as they are numbered
        kind, others = CONE if dragged.are_cones else POLE, vertices[(kinds == CONE) & (not dragged.are_cones)]
        kinds = np.repeat([kind, ZERO, CONE], [len(dragged.poles), len(dragged.zeros), len(others)])
        vertices = np.concatenate([dragged.poles, dragged.zeros, others])
    if len(vertices) and vertices.max() >= len(obj.data.vertices):  # the mesh is not what it was
        vertices, kinds = vertices[:0], kinds[:0]
    hovered = None if dragged is None else dragged.hovered
    is_hovered = np.arange(len(vertices)) == (-1 if hovered is None else hovered)
    return mesh_io.world_points(obj, vertices), kinds, is_hovered


def pixel_sizes(points, view, height):
    """(n,) length of a pixel at each point, in a view (a `RegionView3D`) whose region has this height."""
    perspective, window = np.array(view.perspective_matrix), np.array(view.window_matrix)
    w = points @ perspective[3, :3] + perspective[3, 3]
    return np.abs(w) * 2 / (height * window[1, 1])


def discs(points, radii, axes):
    """(n * 3 CORNERS, 3) float32: triangles of a disc around each point, in the plane of two unit vectors."""
    turn = 2 * np.pi * np.arange(CORNERS + 1) / CORNERS
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1) @ axes
    fan = np.stack([np.zeros((CORNERS, 3)), rim[:-1], rim[1:]], axis=1).reshape(-1, 3)
    return (points[:, None] + radii[:, None, None] * fan[None]).reshape(-1, 3).astype(np.float32)


def _draw_discs(points, colours, opacity, depth_test):
    """Triangles in one colour or in one for each corner."""
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    with_opacity = np.full((len(points), 4), opacity, np.float32)
    with_opacity[:, :3] = colours
    gpu.state.depth_test_set(depth_test)
    batch_for_shader(shader, "TRIS", {"pos": points, "color": with_opacity}).draw(shader)
