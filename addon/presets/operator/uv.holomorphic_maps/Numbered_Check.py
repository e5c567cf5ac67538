# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.main = "AUTOMATIC"
op.density = 1.0
op.margin = 0.02
op.forms = 0
op.shown = 0
op.checker = True
op.texture = "NUMBERED"
op.checker_scale = 0.0
op.seams = False
