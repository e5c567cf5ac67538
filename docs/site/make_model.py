# SPDX-License-Identifier: GPL-3.0-or-later
"""A model for the gallery of the site: an example with a seamless tiling by the headless command, as binary glTF.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/site/make_model.py -- \
    MODEL.glb TEXTURE [OPTION OF THE HEADLESS COMMAND]...

The headless command writes glTF with an object's own materials. Here it gets one that shows the texture.
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


def show(obj, image, roughness):
    """In place of the object's materials."""
    material = bpy.data.materials.new("Tiles")
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = roughness
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    material.node_tree.links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    obj.data.materials.clear()
    obj.data.materials.append(material)


def main():
    model, texture, *options = sys.argv[sys.argv.index("--") + 1 :]
    headless = load_headless()
    module = headless.module
    parse, process = module("command_line.options").parse, module("command_line.command").process
    process(parse(["--seamless", "--texture", texture, *options]))
    image = module("materials.textures").colour_image(texture.upper())
    for obj in [o for o in bpy.context.view_layer.objects if o.type == "MESH"]:
        module("materials.material").uncover(obj)
        show(obj, image, module("materials.patterns").TEXTURES[texture.upper()].roughness)
    bpy.ops.export_scene.gltf(filepath=model, export_format="GLB", export_image_format="JPEG")


main()
