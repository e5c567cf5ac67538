# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

dials = bpy.context.active_object.holomorph_map

dials.tiles = 60
dials.size = 0.0
dials.lattice = "square"
dials.direction = "Z"
dials.boundary = "automatic"
dials.checker = True
dials.texture = "PLANKS"
dials.repeats = 3
