# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.tiles = 60
op.lattice = "square"
op.direction = "Z"
op.boundary = "automatic"
op.checker = True
op.texture = "PLANKS"
op.repeats = 1
