# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.tiles = 100
op.lattice = "square"
op.direction = "UPRIGHT"
op.boundary = "automatic"
op.checker = True
op.texture = "WEAVE"
op.repeats = 2
