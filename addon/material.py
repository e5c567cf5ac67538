# SPDX-License-Identifier: GPL-3.0-or-later
"""The checker: a material that shows a map, put over the mesh's own materials without touching them.

The material slots are linked to the object while the checker is shown, so the mesh keeps its own materials
and `remove_checker` brings them back. One value node scales both patterns: the procedural checker
that is rendered, and a packed image that solid and Workbench views show.
"""

import bpy

from . import compatibility

LIGHT = (0.72, 0.68, 0.60)  # linear RGB, warm white
DARK = (0.03, 0.11, 0.15)  # linear RGB, deep teal
SCALE_NODE = "Checker Scale"
MAP_NODE = "Checker Map"
IMAGE_NODE = "Checker Image"
SQUARES_NODE = "Squares in Image"
IMAGE_SIZE = 256  # pixels, about: a whole number of them for each square
REPLACED = "holomorph_replaced_materials"  # custom property: slot index -> material linked to the object before
OURS = "holomorph_checker"  # custom property that tells our materials and images


def checker_material(map_name, is_attribute, scale):
    """The material that shows `map_name` with `scale` squares per UV unit; made once, then adjusted."""
    name = f"{map_name} Checker" + (" (attribute)" if is_attribute else "")
    material = bpy.data.materials.get((name, None))
    if material is None or OURS not in material or material.node_tree is None:
        material = bpy.data.materials.new(name)
        material[OURS] = True
        _build_nodes(material, map_name, is_attribute)
    nodes = material.node_tree.nodes
    if all(n in nodes for n in (SCALE_NODE, IMAGE_NODE, SQUARES_NODE)):  # else the user has rebuilt them
        nodes[SCALE_NODE].outputs[0].default_value = scale
        nodes[IMAGE_NODE].image = _checker_image(material.name, scale)
        nodes[SQUARES_NODE].inputs[1].default_value = nodes[IMAGE_NODE].image[OURS]
    return material


def show_checker(obj, material):
    """Shows `material` in every slot of `obj`; the mesh's own materials stay where they are."""
    if not obj.material_slots:
        obj.data.materials.append(material)
        return
    replaced = {}
    for index, slot in enumerate(obj.material_slots):
        if _is_checker(slot.material):
            slot.material = material
            continue
        if slot.link == "OBJECT" and slot.material is not None:
            replaced[str(index)] = slot.material
        slot.link = "OBJECT"
        slot.material = material
    if replaced:
        obj[REPLACED] = replaced


def remove_checker(obj):
    """Brings back what `show_checker` covered; returns whether there was a checker."""
    found = any(_is_checker(slot.material) for slot in obj.material_slots)
    replaced = obj.get(REPLACED, {})
    for index, slot in enumerate(obj.material_slots):
        if not _is_checker(slot.material):
            continue
        if slot.link == "OBJECT":
            slot.material = replaced.get(str(index))
            if slot.material is None:
                slot.link = "DATA"
    if len(obj.data.materials) == 1 and _is_checker(obj.data.materials[0]):
        obj.data.materials.clear()
    if REPLACED in obj:
        del obj[REPLACED]
    return found


def has_checker(obj):
    return any(_is_checker(slot.material) for slot in obj.material_slots)


def _is_checker(material):
    return material is not None and OURS in material


def _srgb(linear):
    return tuple(12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear)


def _checker_image(name, scale):
    """The packed image, with an even number of squares across, as near to `scale` as there is."""
    squares = min(max(2 * round(scale / 2), 2), IMAGE_SIZE)
    image = bpy.data.images.get((name, None))
    if image is None or OURS not in image:
        image = bpy.data.images.new(name, IMAGE_SIZE, IMAGE_SIZE)
        image[OURS] = 0
    if image[OURS] != squares:
        width = IMAGE_SIZE // squares
        image.scale(squares * width, squares * width)
        light, dark = ([*_srgb(colour), 1.0] * width for colour in (LIGHT, DARK))
        row, other = (light + dark) * (squares // 2), (dark + light) * (squares // 2)
        image.pixels = (row * width + other * width) * (squares // 2)
        image.pack()
        image[OURS] = squares
    return image


def _build_nodes(material, map_name, is_attribute):
    tree = compatibility.enable_nodes(material)
    tree.nodes.clear()

    def node(kind, x, y, label=""):
        created = tree.nodes.new(kind)
        created.location = (x, y)
        if label:
            created.name = created.label = label
        return created

    if is_attribute:  # a UV Map node finds UV maps only
        source = node("ShaderNodeAttribute", -900, 100, MAP_NODE)
        source.attribute_name = map_name
        vector = source.outputs["Vector"]
    else:
        source = node("ShaderNodeUVMap", -900, 100, MAP_NODE)
        source.uv_map = map_name
        vector = source.outputs[0]
    scale = node("ShaderNodeValue", -900, -120, SCALE_NODE)
    checker = node("ShaderNodeTexChecker", -360, 200)
    checker.inputs["Color1"].default_value = (*LIGHT, 1.0)
    checker.inputs["Color2"].default_value = (*DARK, 1.0)
    shader = node("ShaderNodeBsdfPrincipled", -80, 200)
    shader.inputs["Roughness"].default_value = 0.45
    compatibility.set_specular(shader, 0.35)
    output = node("ShaderNodeOutputMaterial", 240, 200)
    per_image = node("ShaderNodeMath", -720, -200, SQUARES_NODE)
    per_image.operation = "DIVIDE"
    scaled = node("ShaderNodeVectorMath", -540, -100)
    scaled.operation = "SCALE"
    picture = node("ShaderNodeTexImage", -360, -60, IMAGE_NODE)
    picture.interpolation = "Closest"
    link = tree.links.new
    link(vector, checker.inputs["Vector"])
    link(scale.outputs[0], checker.inputs["Scale"])
    link(checker.outputs[0], shader.inputs["Base Color"])
    link(shader.outputs[0], output.inputs["Surface"])
    link(scale.outputs[0], per_image.inputs[0])
    link(vector, scaled.inputs[0])
    link(per_image.outputs[0], scaled.inputs["Scale"])
    link(scaled.outputs[0], picture.inputs["Vector"])
    tree.nodes.active = picture  # what solid view with texture colour and Workbench show
    picture.select = True
