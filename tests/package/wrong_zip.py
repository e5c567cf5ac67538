"""Run in a Blender, any version: installs a zip that was made for another one, and prints what the add-on says.

BLENDER_USER_RESOURCES and BLENDER_USER_SCRIPTS are fresh folders, so that nobody's own settings are touched.
"""

import os
import sys

import bpy

MODULE = "holomorph_addon"

bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
bpy.ops.preferences.addon_enable(module=MODULE)
print("problem:", sys.modules[f"{MODULE}.native"].problem())
bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12)
assert not bpy.ops.uv.holomorphic_maps.poll()
# Classes that are still registered at the end make some versions crash or hang there.
bpy.ops.preferences.addon_disable(module=MODULE)
sys.stdout.flush()
os._exit(0)
