# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the example files of this folder with Blender's own tools. Run it with Blender 3.4:

blender -b --factory-startup --python-exit-code 1 --python blend_examples/make_examples.py [-- folder [name]...]

3.4 because its files open in every later version. Each mesh is checked before it is saved: manifold, and of the genus
and number of boundary loops stated in EXAMPLES.
"""

import math
import sys
from pathlib import Path

import bmesh
import bpy
from mathutils import Euler, Matrix, Vector


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
    """A mug of quads: a turned body, two faces of its wall drawn out and joined to a handle."""
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
    wall = [face_between(bm, rings[k], rings[k + 1]) for k in (6, 2)]
    path = [[(0.25, 0.02), (0.5, -0.06), (0.66, -0.22)], [(0.22, 0.0), (0.46, 0.1), (0.64, 0.26)]]
    tips = []
    for face, steps in zip(wall, path):
        origin = face.calc_center_median()
        outward = Vector((origin.x, origin.y, 0)).normalized()
        for out, up in steps:
            face = bmesh.ops.extrude_discrete_faces(bm, faces=[face])["faces"][0]
            target = origin + out * outward + Vector((0, 0, up))
            bmesh.ops.translate(bm, verts=face.verts, vec=target - face.calc_center_median())
            bmesh.ops.scale(bm, verts=face.verts, vec=(0.96, 0.96, 0.92), space=Matrix.Translation(-target))
        tips.append(face)
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
    """A trefoil knot of swelling thickness, about 100 000 quads."""
    count = 60
    points = []
    for index in range(count):
        t = 2 * math.pi * index / count
        radius = 1.0 + 0.35 * math.cos(2 * t + 0.4)
        place = (math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -math.sin(3 * t))
        points.append((*(0.5 * x for x in place), radius))
    curve = bevel_curve("Knot", points, radius=0.24, cyclic=True, resolution=52, around=14)
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


def pipe():
    """A bent pipe with swellings, open at both ends: a straight strip in UV."""
    points = [(0, 0, 0, 1.0), (1.2, 0, 0, 1.0), (2.2, 0.2, 0.3, 1.25), (2.6, 1.4, 0.8, 1.0), (1.4, 2.0, 1.3, 1.0)]
    points += [(0.2, 1.4, 1.8, 1.35), (0.2, 0.2, 2.3, 1.0), (1.4, 0.0, 2.8, 0.9), (2.6, 0.6, 2.9, 1.2)]
    points += [(3.4, 1.0, 2.9, 1.3)]
    curve = bevel_curve("Pipe", points, radius=0.3, cyclic=False, resolution=16, around=8)
    curve.data.use_fill_caps = False
    return [convert_to_mesh(curve)]


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


def skinned(name, bm):
    """An object of the skin modifier around edges, of one smooth surface."""
    obj = object_of(name, bm)
    obj.modifiers.new("Skin", "SKIN").branch_smoothing = 0.6
    subdivision = obj.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = 2
    remesh = obj.modifiers.new("Remesh", "REMESH")  # the skin crosses itself where limbs and toes branch off
    remesh.mode, remesh.voxel_size = "VOXEL", 0.03
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


def face_height(x, y):
    """The relief of a mask over the unit disk: brow, eyes, nose, lips and chin on a dome."""

    def bump(cx, cy, wx, wy):
        return math.exp(-(((x - cx) / wx) ** 2) - ((y - cy) / wy) ** 2)

    eyes = sum(bump(s * 0.34, 0.22, 0.17, 0.1) for s in (-1, 1))
    lids = sum(bump(s * 0.34, 0.22, 0.09, 0.06) for s in (-1, 1))
    brow = sum(bump(s * 0.33, 0.4, 0.24, 0.08) for s in (-1, 1))
    nose = 0.34 * bump(0, -0.1, 0.11, 0.12) + 0.22 * bump(0, 0.1, 0.08, 0.22)
    lips = 0.1 * bump(0, -0.43, 0.22, 0.05) + 0.09 * bump(0, -0.55, 0.18, 0.05) - 0.07 * bump(0, -0.49, 0.2, 0.025)
    dome = 0.75 * math.sqrt(max(1.08 - x * x - y * y, 0))
    return dome - 0.2 * eyes + 0.12 * lids + 0.09 * brow + nose + lips + 0.1 * bump(0, -0.8, 0.2, 0.14)


def mask():
    """The same mask twice, in edit mode: with one selected vertex, the centre of a disk, and with four, the corners of
    a rectangle."""
    count = 48
    objects = []
    turn = Matrix.Rotation(math.radians(30), 3, "Z")
    for name, shift in (("Mask as Disk", -0.85), ("Mask as Rectangle", 0.85)):
        bm = bmesh.new()
        grid = [[None] * (count + 1) for _ in range(count + 1)]
        for i in range(count + 1):
            for j in range(count + 1):
                a, b = 2 * i / count - 1, 2 * j / count - 1
                # The square as a disk: each coordinate shrinks with the other.
                x, y = a * math.sqrt(1 - b * b / 2), b * math.sqrt(1 - a * a / 2)
                grid[i][j] = bm.verts.new((0.78 * x, y, face_height(x, y)))
        for i in range(count):
            for j in range(count):
                bm.faces.new((grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]))
        nose = grid[count // 2][round(0.45 * count)]
        picked = [nose] if "Disk" in name else [grid[i][j] for i, j in ((0, 0), (count, 0), (count, count), (0, count))]
        for vertex in picked:
            vertex.select = True
        obj = object_of(name, bm)
        obj.location, obj.rotation_euler = turn @ Vector((shift, 0, 0)), Euler((math.radians(70), 0, math.radians(30)))
        objects.append(obj)
    return objects


# name of the file and maker: for each object (genus, boundary loops) of its parts, sorted
EXAMPLES = {
    torus: [[(1, 0)]],
    mug: [[(1, 0)]],
    pretzel: [[(3, 0)]],
    chain: [[(1, 0)] * 7],
    gear: [[(6, 0)]],
    knot: [[(1, 0)]],
    lantern: [[(13, 0)]],
    clay: [[(2, 0)]],
    mixed: [[(0, 0), (1, 0)], [(0, 1)]],
    hand: [[(0, 6)]],
    pipe: [[(0, 2)]],
    critter: [[(0, 0)]],
    lizard: [[(0, 0)]],
    armadillo: [[(0, 0)]],
    text: [[(0, 0)] * 5 + [(1, 0)] * 4],
    mask: [[(0, 1)], [(0, 1)]],
}
EDITED = {mask}  # saved in edit mode, for the sake of the selected vertices


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


def part_topologies(mesh):
    """(genus, boundary loops) of each connected part, sorted; raises on a mesh that is not a manifold."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    unseen, found = set(bm.verts), []
    while unseen:
        part = connected({unseen.pop()}, lambda v: v.link_edges)
        unseen -= part
        edges = {e for v in part for e in v.link_edges}
        faces = {f for v in part for f in v.link_faces}
        boundary = [e for e in edges if e.is_boundary]
        fans_whole = all(sum(e.is_boundary for e in v.link_edges) in (0, 2) for v in part)
        if any(len(e.link_faces) not in (1, 2) for e in edges) or not fans_whole:
            raise RuntimeError(f"{mesh.name} is not a manifold")
        loops, rest = 0, {v for e in boundary for v in e.verts}
        while rest:
            rest -= connected({rest.pop()}, lambda v: [e for e in v.link_edges if e.is_boundary])
            loops += 1
        found.append(((2 - loops - (len(part) - len(edges) + len(faces))) // 2, loops))
    bm.free()
    return sorted(found)


def connected(front, edges_of):
    """The vertices that the edges lead to from those in `front`."""
    seen = set()
    while front:
        vertex = front.pop()
        seen.add(vertex)
        front |= {e.other_vert(vertex) for e in edges_of(vertex)} - seen
    return seen


def save(make, expected, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    objects = make()
    for obj, topologies in zip(objects, expected):
        while obj.data.uv_layers:
            obj.data.uv_layers.remove(obj.data.uv_layers[0])
        obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
        obj.data.use_auto_smooth, obj.data.auto_smooth_angle = True, math.radians(40)
        found = part_topologies(obj.data)
        print(f"{make.__name__}: {obj.name}, {len(obj.data.polygons)} faces, (genus, boundary loops) of parts {found}")
        if found != topologies:
            raise RuntimeError(f"{obj.name}: {found}, expected {topologies}")
    select_only(objects[0])
    for obj in objects:
        obj.select_set(True)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    if make in EDITED:
        bpy.ops.object.mode_set(mode="EDIT")
    path = folder / f"{make.__name__}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False, compress=True)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    folder = Path(arguments[0]) if arguments else Path(__file__).resolve().parent
    for make, expected in EXAMPLES.items():
        if make.__name__ in arguments[1:] or len(arguments) < 2:
            save(make, expected, folder.resolve())


if __name__ == "__main__":
    main()
