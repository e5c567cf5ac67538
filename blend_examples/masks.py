# SPDX-License-Identifier: GPL-3.0-or-later
"""The example of a face over the unit disk."""

import math

import bmesh
from mathutils import Euler, Matrix, Vector
from modeling import object_of


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
