# SPDX-License-Identifier: GPL-3.0-or-later
"""A model for the gallery of the site: an example with a seamless tiling by the headless command, as binary glTF.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/site/make_model.py -- \
    MODEL.glb TEXTURE [OPTION OF THE HEADLESS COMMAND]...

As the headless command does with --export-texture, but with JPEG images, which are a fifth of the size.
"""

import importlib.util
import sys
from pathlib import Path

import bpy

HEADLESS = Path(__file__).resolve().parents[2] / "addon" / "headless.py"


def load_headless():
    spec = importlib.util.spec_from_file_location("headless", HEADLESS)
    headless = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(headless)
    return headless


def main():
    model, texture, *options = sys.argv[sys.argv.index("--") + 1 :]
    headless = load_headless()
    module = headless.module
    parse, process = module("command_line.options").parse, module("command_line.command").process
    process(parse(["--seamless", "--texture", texture, *options]))
    for obj in [o for o in bpy.context.view_layer.objects if o.type == "MESH"]:
        module("materials.plain").show(obj)
    bpy.ops.export_scene.gltf(filepath=model, export_format="GLB", export_image_format="JPEG")


main()
