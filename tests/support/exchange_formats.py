"""Which formats of exchange each Blender can write, and how."""

import bpy
import pytest

needs_usd = pytest.mark.skipif(not bpy.app.build_options.usd, reason="this Blender is built without USD")

# Blender 4.2 as a Python module crashes at exit once it has written a glTF file, with no add-on either.
may_write_gltf = pytest.mark.skipif(
    bpy.app.version[:2] == (4, 2) and not bpy.app.binary_path, reason="this Blender crashes at exit after writing glTF"
)

SCENES = [
    pytest.param(".glb", marks=may_write_gltf),
    ".fbx",
    pytest.param(".usdc", marks=needs_usd),
]


def write(path):
    """The scene as a file, by Blender's own exporter."""
    exporter, options = {
        ".glb": (bpy.ops.export_scene.gltf, {"export_cameras": True}),
        ".fbx": (bpy.ops.export_scene.fbx, {}),
        ".usdc": (bpy.ops.wm.usd_export, {}),
    }[path.suffix]
    exporter(filepath=str(path), **options)
