# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.tiles = 0
op.lattice = "square"
op.direction = "UPRIGHT"
op.boundary = "automatic"
op.checker = True
op.texture = "NUMBERED"
op.repeats = 1
