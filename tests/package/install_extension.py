"""Run by Blender as a Python module, 4.2 or later: installs the extension's zip, uses it, removes it.

BLENDER_USER_RESOURCES is a fresh folder, so that nobody's own settings are touched.
"""

import importlib
import os
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
import use_addon

MODULE = "bl_ext.user_default.holomorph"

bpy.ops.extensions.package_install_files(
    filepath=sys.argv[-1], repo="user_default", enable_on_install=True, overwrite=True
)
# The operator reports success even where it did nothing.
assert MODULE in bpy.context.preferences.addons, "the extension was not enabled"
folder = Path(importlib.import_module(MODULE).__file__).parent
before = sorted(folder.rglob("*"))
use_addon.use()
new = [path for path in set(folder.rglob("*")) - set(before) if "__pycache__" not in path.parts]
assert not new, f"the extension writes beside itself: {new}"
# Classes that are still registered at the end make some versions crash or hang there.
bpy.ops.preferences.addon_disable(module=MODULE)
assert not hasattr(bpy.types, "HOLOMORPH_PT_view3d"), "the add-on leaves classes behind"
sys.stdout.flush()
os._exit(0)
