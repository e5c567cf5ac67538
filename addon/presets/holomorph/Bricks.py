# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

dials = bpy.context.active_object.holomorph_map

dials.tiles = 100
dials.size = 0.0
dials.lattice = "square"
dials.direction = "UPRIGHT"
dials.boundary = "automatic"
dials.checker = True
dials.texture = "BRICKS"
dials.repeats = 2
