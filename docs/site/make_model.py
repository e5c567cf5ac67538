# SPDX-License-Identifier: GPL-3.0-or-later
"""A model for the gallery of the site: an example with a seamless tiling by the headless program, as binary glTF, whose
materials are images of the texture.

blender -b EXAMPLE.blend --factory-startup --python-exit-code 1 --python docs/site/make_model.py -- \
    MODEL.glb [NAME=VALUE, a property of Seamless Tiling]...
"""

import runpy
import sys
from pathlib import Path

import bpy

FOLDERS = Path(__file__).resolve().parents[2] / "addon" / "folders.py"


def show(obj, module):
    """Puts plain materials into the slots that ours cover."""
    material, nodes = module("materials.material"), module("materials.nodes")
    for slot in obj.material_slots:
        if material.is_ours(slot.material):
            shown, plain = slot.material, bpy.data.materials.new(f"{slot.material.name} Image")
            build_plain(nodes, plain, shown)
            slot.material = plain


def build_plain(nodes, material, shown):
    """The image that another of our materials has for views without shading, over the whole UV square."""
    own = shown.node_tree.nodes
    image = next(own[name].image for name in (nodes.PREVIEW_NODE, nodes.IMAGE_NODE) if name in own)
    shader = next(node for node in own if node.type == "BSDF_PRINCIPLED")
    tree = nodes.Tree.of(material)
    picture = tree.node("ShaderNodeTexImage", -480, 200, image=image)
    tree.link(tree.map_vector(own[nodes.MAP_NODE].uv_map, is_attribute=False), picture.inputs["Vector"])
    tree.link(picture.outputs[0], tree.shader(shader.inputs["Roughness"].default_value).inputs["Base Color"])


def main():
    model, *properties = sys.argv[sys.argv.index("--") + 1 :]
    module = runpy.run_path(str(FOLDERS))["module"]
    headless = module("headless")
    headless.process(headless.parse(["--press", "tile", *(word for one in properties for word in ("--set", one))]))
    for obj in [o for o in bpy.context.view_layer.objects if o.type == "MESH"]:
        show(obj, module)
    bpy.ops.export_scene.gltf(filepath=model, export_format="GLB", export_image_format="JPEG")


main()
