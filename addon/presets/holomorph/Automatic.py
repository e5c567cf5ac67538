# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

dials = bpy.context.active_object.holomorph_map

dials.tiles = 0
dials.size = 0.0
dials.lattice = "automatic"
dials.direction = "UPRIGHT"
dials.boundary = "automatic"
dials.checker = True
dials.texture = "CHECKER"
dials.repeats = 1
