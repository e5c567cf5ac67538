# SPDX-License-Identifier: GPL-3.0-or-later
"""What only files of blend_examples/things show: a vase to print, a figure for a game. Each function gives an object in
an empty file."""

import math

import bmesh
from creatures import skinned, strand
from mathutils import Euler
from modeling import object_of, ring_edges, subdivide, turned_ring

SIDES = 48  # of the vase


def vase():
    """Turned in millimetres, with a wall of 8 and a foot; closed, without a handle."""
    bm = bmesh.new()
    outer = [(20, 0), (29, 0), (31, 1.5), (31, 5), (28.5, 9), (33, 18), (39, 29), (43, 41), (44.5, 53), (43, 65)]
    outer += [(38, 77), (30.5, 88), (24, 97), (21, 105), (21.5, 113), (25.5, 121), (31, 127)]
    inner = [(31, 130.5), (28, 132), (25, 130.5), (19, 123), (14.5, 114), (13.5, 105), (16, 96), (22.5, 86), (30, 75)]
    inner += [(35, 64), (36.5, 53), (35, 41), (31, 31), (25, 22), (18, 16), (9, 13.5)]
    rings = [turned_ring(bm, radius, height, SIDES) for radius, height in outer + inner]
    for lower, upper in zip(rings, rings[1:]):
        bmesh.ops.bridge_loops(bm, edges=ring_edges(bm, lower) + ring_edges(bm, upper))
    for ring in (rings[0], rings[-1]):
        bmesh.ops.poke(bm, faces=[bm.faces.new(ring)])
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    obj = object_of("Vase", bm)
    subdivide(obj, 1)
    return obj


def human():
    """Upright, arms away from the body, with feet and thumbs; closed, without a handle."""
    bm = bmesh.new()
    radius = bm.verts.layers.skin.verify()
    spine = [(0, 0, 1.0, 0.17), (0, 0.0, 1.16, 0.14), (0, 0.01, 1.34, 0.17), (0, 0.02, 1.47, 0.12)]
    spine += [(0, 0.01, 1.57, 0.065), (0, -0.02, 1.7, 0.125), (0, -0.01, 1.82, 0.11)]
    hips, _, chest, *_ = body = strand(bm, radius, spine)
    for side in (-1, 1):
        leg = [(side * 0.13, 0, 0.82, 0.115), (side * 0.15, -0.01, 0.52, 0.085), (side * 0.16, 0.01, 0.3, 0.08)]
        leg += [(side * 0.17, 0.02, 0.1, 0.07), (side * 0.19, -0.14, 0.06, 0.065)]
        arm = [(side * 0.22, 0.02, 1.4, 0.08), (side * 0.42, 0.02, 1.22, 0.06), (side * 0.6, -0.02, 1.05, 0.05)]
        arm += [(side * 0.69, -0.05, 0.97, 0.065)]
        strand(bm, radius, leg, hips)
        hand = strand(bm, radius, arm, chest)[-1]
        strand(bm, radius, [(side * 0.79, -0.06, 0.86, 0.05)], hand)
        strand(bm, radius, [(side * 0.69, -0.15, 0.93, 0.035)], hand)
    body[0][radius].use_root = True
    obj = skinned("Human", bm, voxel=0.02)
    obj.rotation_euler = Euler((0, 0, math.radians(20)))
    return obj
