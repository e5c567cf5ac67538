# SPDX-License-Identifier: GPL-3.0-or-later
"""What the examples are modelled with: extrusion, rings, curves, modifiers."""

import math

import bmesh
import bpy
from mathutils import Matrix


def drawn_out(bm, face, target, size, turn=0.0):
    """The face extruded so that its middle comes to `target`, scaled, and turned about the y axis (radians)."""
    face = bmesh.ops.extrude_discrete_faces(bm, faces=[face])["faces"][0]
    bmesh.ops.translate(bm, verts=face.verts, vec=target - face.calc_center_median())
    around = Matrix.Translation(-target)
    bmesh.ops.scale(bm, verts=face.verts, vec=(size, size, size), space=around)
    bmesh.ops.rotate(bm, verts=face.verts, cent=target, matrix=Matrix.Rotation(turn, 3, "Y"))
    return face


def turned_ring(bm, radius, height, sides):
    angles = [2 * math.pi * k / sides for k in range(sides)]
    return [bm.verts.new((radius * math.cos(a), radius * math.sin(a), height)) for a in angles]


def ring_edges(bm, ring):
    pairs = zip(ring, ring[1:] + ring[:1])
    return [bm.edges.get(pair) or bm.edges.new(pair) for pair in pairs]


def face_between(bm, lower, upper):
    return bm.faces.get((lower[0], lower[1], upper[1], upper[0]))


def object_of(name, bm):
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def select_only(obj):
    bpy.context.view_layer.update()  # or it lists objects that are gone
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj


def bevel_curve(name, points, radius, cyclic, resolution, around=8):
    """A tube of round section through `points` (x, y, z, thickness), with closed ends."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions, data.bevel_depth, data.bevel_resolution = "3D", radius, around
    data.use_fill_caps, data.resolution_u = not cyclic, resolution
    spline = data.splines.new("NURBS")
    spline.points.add(len(points) - 1)
    for target, (x, y, z, thickness) in zip(spline.points, points):
        target.co, target.radius = (x, y, z, 1.0), thickness
    spline.use_cyclic_u, spline.use_endpoint_u, spline.order_u = cyclic, True, 4
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def convert_to_mesh(obj):
    """The mesh that Blender shows for a curve or metaball object, as an object in its place."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    bm = bmesh.new()
    bm.from_mesh(bpy.data.meshes.new_from_object(evaluated))
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-5)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    name = obj.name
    bpy.data.objects.remove(obj)
    return object_of(name, bm)


def subdivide(obj, levels):
    subdivision = obj.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = levels
    apply_modifiers(obj)


def apply_modifiers(obj):
    select_only(obj)
    for modifier in list(obj.modifiers):
        bpy.ops.object.modifier_apply(modifier=modifier.name)
