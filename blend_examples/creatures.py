# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples with limbs: hand, critter, lizard, armadillo. Each function gives the objects of one file."""

import math

import bmesh
import bpy
from mathutils import Euler, Vector
from modeling import apply_modifiers, convert_to_mesh, drawn_out, object_of, subdivide


def hand():
    """A hand as in the paper's Figure 5: open at the wrist, with a hole at each fingertip; fingers and thumb are drawn
    out of the faces of a box."""
    bm = bmesh.new()
    tops, thumb = palm(bm)
    tips = []
    lengths, leanings = (1.9, 2.3, 2.1, 1.6), (-0.16, -0.04, 0.08, 0.22)
    for face, length, leaning in zip(tops, lengths, leanings):
        origin = face.calc_center_median()
        for share, size in ((0.06, 0.74), (0.36, 0.98), (0.42, 1.03), (0.68, 0.93), (0.74, 0.98), (0.97, 0.8)):
            target = origin + Vector((leaning * share * length, -0.1 * length * share**2, share * length))
            face = drawn_out(bm, face, target, size)
        tips.append(face)
    origin, face = thumb.calc_center_median(), thumb
    for out, up, size in ((0.22, 0.1, 0.8), (0.62, 0.5, 0.86), (0.72, 0.62, 1.04), (0.98, 1.12, 0.9), (1.06, 1.4, 0.8)):
        face = drawn_out(bm, face, origin + Vector((-out, -0.2 * out, up)), size, turn=math.radians(14))
    tips.append(face)
    bmesh.ops.delete(bm, geom=tips, context="FACES_ONLY")
    obj = object_of("Hand", bm)
    subdivide(obj, 3)
    return [obj]


def palm(bm):
    """Forearm and palm, one box for each finger's width; returns the faces on top and the one of the thumb."""
    rows = [(-3.4, 0.50, 0.36), (-2.4, 0.46, 0.34), (-1.7, 0.62, 0.38), (-0.9, 0.92, 0.42), (0.0, 1.02, 0.40)]
    rows += [(0.8, 1.0, 0.36)]  # height, half width, half depth
    front, back = (
        [[bm.verts.new((width * x, side * depth, z)) for x in (-1.0, -0.5, 0.0, 0.5, 1.0)] for z, width, depth in rows]
        for side in (-1, 1)
    )
    inner = []  # the faces on the thumb's side
    for low in range(len(rows) - 1):
        up = low + 1
        for k in range(4):
            bm.faces.new((front[low][k], front[low][k + 1], front[up][k + 1], front[up][k]))
            bm.faces.new((back[low][k + 1], back[low][k], back[up][k], back[up][k + 1]))
        inner.append(bm.faces.new((back[low][0], front[low][0], front[up][0], back[up][0])))
        bm.faces.new((front[low][4], back[low][4], back[up][4], front[up][4]))
    tops = [bm.faces.new((front[-1][k], front[-1][k + 1], back[-1][k + 1], back[-1][k])) for k in range(4)]
    return tops, inner[3]


def critter():
    """An animal of clay, without a handle: the texture runs in rings from the nose to the tail."""
    data = bpy.data.metaballs.new("Critter")
    data.resolution = data.render_resolution = 0.05
    obj = bpy.data.objects.new("Critter", data)
    bpy.context.scene.collection.objects.link(obj)
    balls = [((0.24 * k - 0.84, 0, 0.86 + 0.05 * math.sin(k)), 0.5) for k in range(8)]
    balls += [((0.98, 0, 1.2), 0.36), ((1.12, 0, 1.5), 0.42), ((1.36, 0, 1.48), 0.32), ((1.56, 0, 1.43), 0.24)]
    balls += [((-1.0 - 0.16 * k, 0, 1.0 + 0.07 * k), 0.26 - 0.022 * k) for k in range(6)]
    for side in (-1, 1):
        balls += [((x, side * (0.24 + 0.03 * k), 0.62 - 0.14 * k), 0.27) for x in (-0.66, 0.62) for k in range(5)]
        balls += [((1.02 - 0.03 * k, side * (0.2 + 0.07 * k), 1.74 + 0.09 * k), 0.19) for k in range(4)]
    for place, radius in balls:
        ball = data.elements.new()
        ball.co, ball.radius = place, radius
    obj = convert_to_mesh(obj)
    obj.rotation_euler = Euler((0, 0, math.radians(-35)))
    return [obj]


def lizard():
    """A lizard of Blender's skin modifier: a spine, four legs and toes, without a handle."""
    spine = [(2.0, 0.0, 0.34, 0.09), (1.7, 0.0, 0.4, 0.16), (1.3, 0.0, 0.44, 0.15), (0.7, 0.06, 0.42, 0.17)]
    spine += [(0.1, 0.06, 0.44, 0.26), (-0.5, -0.04, 0.42, 0.17), (-1.0, -0.1, 0.36, 0.14), (-1.5, 0.02, 0.28, 0.1)]
    spine += [(-2.0, 0.25, 0.2, 0.07), (-2.45, 0.35, 0.18, 0.045)]
    bm = bmesh.new()
    radius = bm.verts.layers.skin.verify()
    body = strand(bm, radius, spine)
    for joint, step in ((3, 0.1), (5, -0.1)):
        for side in (-1, 1):
            x, y, z = body[joint].co
            leg = [(x + step, y + side * 0.36, 0.36, 0.1), (x + 2.2 * step, y + side * 0.64, 0.32, 0.09)]
            leg += [(x + 2.6 * step + 0.05, y + side * 0.78, 0.06, 0.06)]
            foot = strand(bm, radius, leg, body[joint])[-1]
            for turn in (-0.7, 0.7):
                toe = foot.co + Vector((0.26 * math.cos(turn), side * 0.26 * math.sin(turn), -0.01))
                strand(bm, radius, [(*toe, 0.045)], foot)
    body[1][radius].use_root = True
    obj = skinned("Lizard", bm)
    obj.rotation_euler = Euler((0, 0, math.radians(-30)))
    return [obj]


def armadillo():
    """Upright, like an armadillo on its hind legs: ears, snout, tail, three fingers and toes each; without a handle."""
    bm = bmesh.new()
    radius = bm.verts.layers.skin.verify()
    spine = [(0, 0, 0.85, 0.3), (0, -0.05, 1.15, 0.36), (0, 0, 1.5, 0.29), (0, -0.06, 1.8, 0.17), (0, -0.16, 2.02, 0.2)]
    spine += [(0, -0.44, 1.95, 0.11), (0, -0.6, 1.9, 0.07)]
    hips, _, chest, _, head, *_ = body = strand(bm, radius, spine)
    tail = [(0, 0.36, 0.62, 0.18), (0, 0.66, 0.36, 0.12), (0.06, 0.95, 0.2, 0.09), (0.2, 1.25, 0.2, 0.06)]
    strand(bm, radius, tail, hips)
    for side in (-1, 1):
        strand(bm, radius, [(side * 0.19, -0.08, 2.22, 0.08), (side * 0.3, -0.04, 2.44, 0.05)], head)
        leg = [(side * 0.32, -0.04, 0.6, 0.18), (side * 0.38, -0.1, 0.32, 0.13), (side * 0.4, -0.04, 0.09, 0.1)]
        arm = [(side * 0.4, -0.03, 1.54, 0.14), (side * 0.66, -0.1, 1.34, 0.1), (side * 0.76, -0.34, 1.46, 0.09)]
        for limb, joint, reach in ((leg, hips, 0.3), (arm, chest, 0.24)):
            end = strand(bm, radius, limb, joint)[-1]
            for turn in (-0.6, 0.0, 0.6):
                tip = end.co + Vector((reach * math.sin(turn), -reach * math.cos(turn), 0.12 if limb is arm else -0.02))
                strand(bm, radius, [(*tip, 0.05)], end)
    body[0][radius].use_root = True
    obj = skinned("Armadillo", bm)
    obj.rotation_euler = Euler((0, 0, math.radians(25)))
    return [obj]


def skinned(name, bm, voxel=0.03):
    """An object of the skin modifier around edges, of one smooth surface."""
    obj = object_of(name, bm)
    obj.modifiers.new("Skin", "SKIN").branch_smoothing = 0.6
    subdivision = obj.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = 2
    remesh = obj.modifiers.new("Remesh", "REMESH")  # the skin crosses itself where limbs and toes branch off
    remesh.mode, remesh.voxel_size = "VOXEL", voxel
    smooth = obj.modifiers.new("Smooth", "SMOOTH")
    smooth.factor, smooth.iterations = 0.5, 8
    apply_modifiers(obj)
    return obj


def strand(bm, radius, points, start=None):
    """Vertices (x, y, z, radius) for the skin modifier, each joined to the one before, the first to `start`."""
    made = []
    for *place, size in points:
        vertex = bm.verts.new(place)
        vertex[radius].radius = (size, size)
        if start is not None:
            bm.edges.new((start, vertex))
        made.append(vertex)
        start = vertex
    return made
