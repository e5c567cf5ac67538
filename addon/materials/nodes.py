# SPDX-License-Identifier: GPL-3.0-or-later
"""The node trees of materials that show a map: the checker, or a texture that tiles; and such materials as assets."""

import bpy

from .. import compatibility
from ..scene.uv_maps import MAIN_MAP
from . import textures
from .patterns import TEXTURES

OURS = "holomorph_checker"  # custom property that tells our materials
LIGHT = (0.72, 0.68, 0.60)  # linear RGB, warm white
DARK = (0.03, 0.11, 0.15)  # linear RGB, deep teal
SCALE_NODE = "Checker Scale"
MAP_NODE = "Checker Map"
IMAGE_NODE = "Checker Image"
SHIFT_NODE = "Checker Shift"
SQUARES_NODE = "Squares in Image"
REPEATS_NODE = "Repeats"
RELIEF_NODE = "Relief"
HEIGHT_NODE = "Image Height"  # of an image of the user's, in its width
CENTRE_NODE = "Image Centre"  # of its turns, at the corners of tiles
PREVIEW_NODE = "Preview"


class Tree:
    """A node tree while it is built; `left` is where its middle is, in the editor's units."""

    def __init__(self, tree, left=0):
        self.tree, self._left = tree, left

    @classmethod
    def of(cls, material):
        """The node tree of a material, emptied."""
        made = cls(compatibility.enable_nodes(material))
        made.tree.nodes.clear()
        return made

    def node(self, kind, x, y, label="", **settings):
        created = self.tree.nodes.new(kind)
        created.location = (self._left + x, y)
        if label:
            created.name = created.label = label
        for name, value in settings.items():
            setattr(created, name, value)
        return created

    def link(self, source, target):
        self.tree.links.new(source, target)

    def map_vector(self, map_name, is_attribute, label=MAP_NODE):
        """The socket that gives a map's UVs."""
        if is_attribute:  # a UV Map node finds UV maps only
            source = self.node("ShaderNodeAttribute", -900, 100, label, attribute_name=map_name)
            return source.outputs["Vector"]
        return self.node("ShaderNodeUVMap", -900, 100, label, uv_map=map_name).outputs[0]

    def number(self, operation, *values, x):
        """Adds an operation on sockets; returns its socket."""
        node = self.node("ShaderNodeMath", x, -100, operation=operation)
        for value, socket in zip(values, node.inputs):
            self.link(value, socket)
        return node.outputs[0]

    def scaled(self, vector, factor, x, y):
        """Adds the product of a vector and a value; returns its socket."""
        node = self.node("ShaderNodeVectorMath", x, y, operation="SCALE")
        self.link(vector, node.inputs[0])
        self.link(factor, node.inputs["Scale"])
        return node.outputs[0]

    def shader(self, roughness):
        """A Principled node that goes to the output."""
        shader = self.node("ShaderNodeBsdfPrincipled", -80, 200)
        shader.inputs["Roughness"].default_value = roughness
        compatibility.set_specular(shader, 0.35)
        output = self.node("ShaderNodeOutputMaterial", 240, 200)
        self.link(shader.outputs[0], output.inputs["Surface"])
        return shader

    def show_in_solid_view(self, picture):
        """What solid view with texture colour and Workbench show: the active node, over the whole UV square."""
        self.tree.nodes.active = picture
        picture.select = True


def build_checker(material, map_name, is_attribute):
    """Procedural squares, and an image of them for views without shading; one value node scales both."""
    tree = Tree.of(material)
    vector = tree.map_vector(map_name, is_attribute)
    scale = tree.node("ShaderNodeValue", -900, -120, SCALE_NODE)
    checker = tree.node("ShaderNodeTexChecker", -360, 200)
    checker.inputs["Color1"].default_value = (*LIGHT, 1.0)
    checker.inputs["Color2"].default_value = (*DARK, 1.0)
    per_image = tree.node("ShaderNodeMath", -720, -200, SQUARES_NODE, operation="DIVIDE")
    picture = tree.node("ShaderNodeTexImage", -360, -60, IMAGE_NODE, interpolation="Closest")
    moved = tree.node("ShaderNodeVectorMath", -540, 200, SHIFT_NODE, operation="ADD")
    tree.link(vector, moved.inputs[0])
    tree.link(moved.outputs[0], checker.inputs["Vector"])
    tree.link(scale.outputs[0], checker.inputs["Scale"])
    tree.link(checker.outputs[0], tree.shader(0.45).inputs["Base Color"])
    tree.link(scale.outputs[0], per_image.inputs[0])
    tree.link(tree.scaled(vector, per_image.outputs[0], -540, -100), picture.inputs["Vector"])
    tree.show_in_solid_view(picture)


def adjust_checker(material, squares, is_centred=False):
    """`is_centred`: the middle of a square lies at the corners of the UV square, instead of a corner."""
    nodes = material.node_tree.nodes
    if not all(name in nodes for name in (SCALE_NODE, IMAGE_NODE, SQUARES_NODE)):
        return  # the user has rebuilt them
    image, shown = textures.checker_image(squares, LIGHT, DARK, is_centred)
    nodes[SCALE_NODE].outputs[0].default_value = squares
    nodes[IMAGE_NODE].image = image
    nodes[SQUARES_NODE].inputs[1].default_value = shown
    if SHIFT_NODE in nodes:  # not in materials of older versions
        shift = 0.5 / squares if is_centred else 0.0
        nodes[SHIFT_NODE].inputs[1].default_value = (shift, shift, 0)


def build_texture(material, texture, map_name, is_attribute):
    """The images of a texture, repeated a whole number of times; the relief by bumps, which need no tangents and so
    show no seam where the map is cut."""
    tree = Tree.of(material)
    vector = tree.map_vector(map_name, is_attribute)
    repeats = tree.node("ShaderNodeValue", -900, -120, REPEATS_NODE)
    at = tree.scaled(vector, repeats.outputs[0], -720, 100)
    picture = tree.node("ShaderNodeTexImage", -480, 200, image=textures.colour_image(texture))
    tree.link(at, picture.inputs["Vector"])
    shader = tree.shader(TEXTURES[texture].roughness)
    tree.link(picture.outputs[0], shader.inputs["Base Color"])
    tree.show_in_solid_view(tree.node("ShaderNodeTexImage", -480, 480, PREVIEW_NODE))
    relief = textures.relief_image(texture)
    if relief is not None:
        tree.link(_bump(tree, at, repeats, relief), shader.inputs["Normal"])


def _bump(tree, at, repeats, relief):
    picture = tree.node("ShaderNodeTexImage", -720, -300, image=relief)
    height = tree.node("ShaderNodeVectorMath", -440, -300, operation="DOT_PRODUCT")
    height.inputs[1].default_value = (1, 1 / textures.STEPS, 0)
    most = tree.node("ShaderNodeValue", -900, -240, RELIEF_NODE)
    distance = tree.node("ShaderNodeMath", -440, -120, operation="DIVIDE")
    bump = tree.node("ShaderNodeBump", -260, -120)
    tree.link(at, picture.inputs["Vector"])
    tree.link(picture.outputs[0], height.inputs[0])
    tree.link(height.outputs["Value"], bump.inputs["Height"])
    tree.link(most.outputs[0], distance.inputs[0])
    tree.link(repeats.outputs[0], distance.inputs[1])
    tree.link(distance.outputs[0], bump.inputs["Distance"])
    return bump.outputs[0]


def adjust_texture(material, texture, repeats, unit_length):
    """`unit_length`: on the surface, of a side of the UV square."""
    nodes = material.node_tree.nodes
    if REPEATS_NODE in nodes:  # else the user has rebuilt them
        nodes[REPEATS_NODE].outputs[0].default_value = repeats
    if RELIEF_NODE in nodes:
        nodes[RELIEF_NODE].outputs[0].default_value = TEXTURES[texture].relief * unit_length
    if PREVIEW_NODE in nodes:
        nodes[PREVIEW_NODE].image = textures.preview_image(texture, repeats)


ASSET = "holomorph_asset"  # custom property that tells them: which texture
ASSET_UNIT = 0.25  # length of a UV unit that reliefs are made for; a value in the nodes, "Relief", has them
ASSET_TAG = "Seamless"


def add_assets():
    """Makes and marks those that the file has not yet; gives them."""
    there = {material.get(ASSET) for material in bpy.data.materials if material.library is None}
    return [_asset(texture) for texture in TEXTURES if texture not in there]


def _asset(texture):
    made = bpy.data.materials.new(f"{textures.label(texture)} on Tiling")
    made[ASSET] = texture
    build_texture(made, texture, MAIN_MAP, is_attribute=False)
    adjust_texture(made, texture, 1, ASSET_UNIT)
    made.asset_mark()
    made.asset_data.description = f"{textures.label(texture)} on the UV map {MAIN_MAP}, made by Seamless Tiling"
    made.asset_data.tags.new(ASSET_TAG)
    if not bpy.app.background:  # a preview is a render
        made.asset_generate_preview()
    return made
