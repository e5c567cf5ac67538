"""Run in Blender 3.4: installs the zip for Blender before 4.2, uses it, removes it.

BLENDER_USER_SCRIPTS is a fresh folder, so that nobody's own settings are touched.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
import use_addon

MODULE = "holomorph_addon"

bpy.ops.preferences.addon_install(filepath=sys.argv[-1])
bpy.ops.preferences.addon_enable(module=MODULE)
assert MODULE in bpy.context.preferences.addons, "the add-on was not enabled"
use_addon.use()
bpy.ops.preferences.addon_disable(module=MODULE)
assert not hasattr(bpy.types, "HOLOMORPH_PT_view3d"), "the add-on leaves classes behind"
