"""Run by Blender as a Python module, 4.2 or later: subscribes to a repository, installs from it, updates, removes.

Arguments: the folder that a web server shows, a folder with the next version of what it has, the address of its index.
BLENDER_USER_RESOURCES is a fresh folder, so that nobody's own settings are touched.
"""

import os
import shutil
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
import use_addon

shown, following, address = sys.argv[-3:]
preferences = bpy.context.preferences
MODULE = "bl_ext.holomorph_repository.holomorph"


def version():
    folder = Path(os.environ["BLENDER_USER_RESOURCES"], "extensions", "holomorph_repository", "holomorph")
    lines = (folder / "blender_manifest.toml").read_text(encoding="utf-8").splitlines()
    return next(line for line in lines if line.startswith("version = "))


preferences.system.use_online_access = True
repositories = preferences.extensions.repos
repositories.new(name="Holomorph", module="holomorph_repository", remote_url=address)
index = repositories.find("Holomorph")
bpy.ops.extensions.repo_sync(repo_index=index)
bpy.ops.extensions.package_install(repo_index=index, pkg_id="holomorph", enable_on_install=True)
# The operators report success even where they did nothing.
assert MODULE in preferences.addons, "the extension was not enabled"
use_addon.use()
print("installed:", version())

shutil.copytree(following, shown, dirs_exist_ok=True)
bpy.ops.extensions.repo_sync(repo_index=index)
bpy.ops.extensions.package_upgrade_all(use_active_only=False)
print("updated:", version())
assert bpy.ops.uv.holomorphic_maps.poll()

# Classes that are still registered at the end make some versions crash or hang there.
bpy.ops.preferences.addon_disable(module=MODULE)
assert not hasattr(bpy.types, "HOLOMORPH_PT_view3d"), "the add-on leaves classes behind"
sys.stdout.flush()
os._exit(0)
