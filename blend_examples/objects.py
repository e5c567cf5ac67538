# SPDX-License-Identifier: GPL-3.0-or-later
"""The other examples: rings, vessels, parts of machines, text. Each function gives the objects of one file."""

import math

import bmesh
import bpy
from mathutils import Euler, Matrix, Vector
from modeling import (
    apply_modifiers,
    bevel_curve,
    convert_to_mesh,
    face_between,
    object_of,
    ring_edges,
    select_only,
    subdivide,
    turned_ring,
)


def torus():
    """A torus of uneven thickness, stretched by the object's own scale."""
    bpy.ops.mesh.primitive_torus_add(major_segments=72, minor_segments=28, major_radius=1.0, minor_radius=0.34)
    obj = bpy.context.object
    shape = obj.modifiers.new("Taper", "SIMPLE_DEFORM")
    shape.deform_method, shape.deform_axis, shape.factor = "TAPER", "X", 0.55
    apply_modifiers(obj)
    obj.scale = (1.3, 1.0, 0.8)
    return [obj]


def mug():
    """A mug of quads: a turned body, a face of its wall drawn out around an arc to another one, as a handle."""
    bm = bmesh.new()
    profile = [(0.55, 0.0), (0.88, 0.02), (0.95, 0.25), (0.96, 0.62), (0.96, 0.98), (0.96, 1.34)]
    profile += [(0.96, 1.7), (0.96, 1.92), (0.91, 1.98), (0.85, 1.92), (0.85, 1.2), (0.84, 0.3), (0.75, 0.14)]
    profile += [(0.5, 0.12)]
    sides = 16
    quarter = sides // 4
    rings = [turned_ring(bm, radius, height, sides) for radius, height in profile]
    for lower, upper in zip(rings, rings[1:]):
        bmesh.ops.bridge_loops(bm, edges=ring_edges(bm, lower) + ring_edges(bm, upper))
    for ring in (rings[0], rings[-1]):
        edges = ring_edges(bm, ring)
        bmesh.ops.grid_fill(bm, edges=edges[:quarter] + edges[2 * quarter : 3 * quarter])
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    face, end = (face_between(bm, rings[k], rings[k + 1]) for k in (6, 2))
    start, stop, steps = face.calc_center_median(), end.calc_center_median(), 6
    middle, up = (start + stop) / 2, (start - stop) / 2
    outward = Vector((start.x, start.y, 0)).normalized()
    for step in range(1, steps):
        angle = math.pi * step / steps
        face = bmesh.ops.extrude_discrete_faces(bm, faces=[face])["faces"][0]
        target = middle + 0.62 * math.sin(angle) * outward + math.cos(angle) * up
        bmesh.ops.translate(bm, verts=face.verts, vec=target - face.calc_center_median())
        turn = Matrix.Rotation(math.pi / steps, 3, up.cross(outward))
        bmesh.ops.rotate(bm, verts=face.verts, cent=target, matrix=turn)
        size = 0.85 if step == 1 else 1.0
        bmesh.ops.scale(bm, verts=face.verts, vec=(size, size, size), space=Matrix.Translation(-target))
    tips = [face, end]
    edges = [edge for face in tips for edge in face.edges]
    bmesh.ops.delete(bm, geom=tips, context="FACES_ONLY")
    bmesh.ops.bridge_loops(bm, edges=edges)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    obj = object_of("Mug", bm)
    subdivide(obj, 2)
    return [obj]


def pretzel():
    """A pretzel: one strand laid over itself, grown together by a voxel remesh."""
    strand = [(0.0, 1.02), (0.62, 0.98), (1.16, 0.5), (1.12, -0.2), (0.62, -0.62), (0.1, -0.34), (-0.34, 0.36)]
    strand += [(-0.5, 0.86)]
    points = [(-x, y) for x, y in reversed(strand[1:])] + strand
    curve = bevel_curve("Pretzel", [(x, y, 0.0, 1.0) for x, y in points], radius=0.17, cyclic=False, resolution=12)
    obj = convert_to_mesh(curve)
    remesh = obj.modifiers.new("Remesh", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", 0.035
    smooth = obj.modifiers.new("Smooth", "SMOOTH")
    smooth.factor, smooth.iterations = 0.5, 12
    apply_modifiers(obj)
    obj.rotation_euler = Euler((math.radians(62), 0, 0))
    return [obj]


def chain():
    """Seven interlocked links: one link and an array that moves and turns each copy."""
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=10, major_radius=0.5, minor_radius=0.13)
    obj = bpy.context.object
    obj.name = obj.data.name = "Chain"
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    for sign in (1, -1):
        half = [v for v in bm.verts if sign * v.co.x > 1e-4]
        bmesh.ops.translate(bm, verts=half, vec=(0.28 * sign, 0, 0))
    bm.to_mesh(obj.data)
    bm.free()
    step = bpy.data.objects.new("Step", None)
    bpy.context.scene.collection.objects.link(step)
    step.location = (1.02, 0, 0.05)
    step.rotation_euler = Euler((math.radians(82), math.radians(4), math.radians(9)))
    subdivide(obj, 1)
    array = obj.modifiers.new("Array", "ARRAY")
    array.count, array.use_relative_offset, array.use_object_offset = 7, False, True
    array.offset_object = step
    bpy.context.view_layer.update()
    apply_modifiers(obj)
    bpy.data.objects.remove(step)
    return [obj]


def gear():
    """A toothed disk; six bores cut out by a boolean leave n-gons where they cross its faces."""
    teeth, rings = 18, 8
    outline = []
    for tooth in range(teeth):
        for offset, radius in ((-0.32, 1.0), (-0.17, 1.2), (0.17, 1.2), (0.32, 1.0)):
            angle = 2 * math.pi * (tooth + offset) / teeth
            outline.append((radius * math.cos(angle), radius * math.sin(angle)))
    bm = bmesh.new()
    loops = []
    for ring in range(rings - 1):
        inner = 1 - ring / rings
        loops.append([bm.verts.new((inner * x, inner * y, 0)) for x, y in outline])
    for outer, inner in zip(loops, loops[1:]):
        bmesh.ops.bridge_loops(bm, edges=ring_edges(bm, outer) + ring_edges(bm, inner))
    bm.faces.new(loops[-1])
    obj = object_of("Gear", bm)
    solid = obj.modifiers.new("Solidify", "SOLIDIFY")
    solid.thickness, solid.offset = 0.32, 0.0
    bores = bmesh.new()
    bmesh.ops.create_cone(bores, cap_ends=True, segments=20, radius1=0.24, radius2=0.24, depth=1.0)
    for index in range(5):
        angle = 2 * math.pi * (index + 0.5) / 5
        place = Matrix.Translation((0.62 * math.cos(angle), 0.62 * math.sin(angle), 0))
        bmesh.ops.create_cone(bores, cap_ends=True, segments=16, radius1=0.17, radius2=0.17, depth=1.0, matrix=place)
    cutter = object_of("Bores", bores)
    cut = obj.modifiers.new("Bores", "BOOLEAN")
    cut.operation, cut.solver, cut.object = "DIFFERENCE", "EXACT", cutter
    apply_modifiers(obj)
    bpy.data.objects.remove(cutter)
    obj.rotation_euler = Euler((math.radians(35), 0, 0))
    return [obj]


def knot():
    """A trefoil knot of swelling thickness, about 27 000 quads."""
    count = 60
    points = []
    for index in range(count):
        t = 2 * math.pi * index / count
        radius = 1.0 + 0.35 * math.cos(2 * t + 0.4)
        place = (math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -math.sin(3 * t))
        points.append((*(0.5 * x for x in place), radius))
    curve = bevel_curve("Knot", points, radius=0.24, cyclic=True, resolution=28, around=6)
    curve.data.twist_mode = "Z_UP"  # the least twist leaves faces that cross where the strand closes
    obj = convert_to_mesh(curve)
    obj.rotation_euler = Euler((math.radians(60), 0, math.radians(20)))
    return [obj]


def lantern():
    """The edges of a cuboctahedron as a frame: more handles than Blender has UV maps."""
    bm = bmesh.new()
    bmesh.ops.create_cube(bm, size=2.0)
    bmesh.ops.bevel(bm, geom=bm.verts, offset=50.0, offset_type="PERCENT", affect="VERTICES", segments=1, profile=0.5)
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-4)
    obj = object_of("Lantern", bm)
    frame = obj.modifiers.new("Wireframe", "WIREFRAME")
    frame.thickness, frame.use_even_offset = 0.28, True
    subdivide(obj, 3)
    return [obj]


def clay():
    """Metaballs along a figure of eight, with two holes."""
    data = bpy.data.metaballs.new("Clay")
    data.resolution = data.render_resolution = 0.06
    obj = bpy.data.objects.new("Clay", data)
    bpy.context.scene.collection.objects.link(obj)
    steps = 14
    for side in (-1, 1):
        for index in range(steps):
            angle = 2 * math.pi * (index + 0.5) / steps
            ball = data.elements.new()
            ball.co = (side * 0.86 + 0.86 * math.cos(angle), 0.8 * math.sin(angle), 0.12 * math.sin(2 * angle))
            ball.radius = 0.52 + 0.08 * math.cos(3 * angle)
    obj = convert_to_mesh(obj)
    obj.rotation_euler = Euler((math.radians(55), 0, 0))
    return [obj]


def mixed():
    """A ring with a pearl in it (one mesh of two parts), and an open bowl beside them."""
    bpy.ops.mesh.primitive_torus_add(major_segments=48, minor_segments=16, minor_radius=0.2)
    ring = bpy.context.object
    ring.name = ring.data.name = "Ring and Pearl"
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.45)
    pearl = bpy.context.object
    select_only(ring)
    pearl.select_set(True)
    bpy.ops.object.join()
    bm = bmesh.new()
    bmesh.ops.create_uvsphere(bm, u_segments=24, v_segments=12, radius=0.6)
    bmesh.ops.delete(bm, geom=[v for v in bm.verts if v.co.z > 0.05], context="VERTS")
    bowl = object_of("Bowl", bm)
    bowl.location = (2.2, 0, 0)
    return [ring, bowl]


def pipe():
    """A bent pipe with swellings, open at both ends: a straight strip in UV."""
    points = [(0, 0, 0, 1.0), (1.2, 0, 0, 1.0), (2.2, 0.2, 0.3, 1.25), (2.6, 1.4, 0.8, 1.0), (1.4, 2.0, 1.3, 1.0)]
    points += [(0.2, 1.4, 1.8, 1.35), (0.2, 0.2, 2.3, 1.0), (1.4, 0.0, 2.8, 0.9), (2.6, 0.6, 2.9, 1.2)]
    points += [(3.4, 1.0, 2.9, 1.3)]
    curve = bevel_curve("Pipe", points, radius=0.3, cyclic=False, resolution=16, around=8)
    curve.data.use_fill_caps = False
    return [convert_to_mesh(curve)]


def text():
    """The project's name in letters of Blender's own font: nine parts, four of them with a handle."""
    data = bpy.data.curves.new("Text", "FONT")
    data.body, data.extrude, data.resolution_u = "Holomorph", 0.12, 6
    data.space_character = 1.06
    obj = bpy.data.objects.new("Text", data)
    bpy.context.scene.collection.objects.link(obj)
    obj = convert_to_mesh(obj)
    remesh = obj.modifiers.new("Remesh", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", 0.026
    smooth = obj.modifiers.new("Smooth", "SMOOTH")
    smooth.factor, smooth.iterations = 0.5, 5
    apply_modifiers(obj)
    obj.rotation_euler = Euler((math.radians(80), 0, math.radians(18)))
    return [obj]
