# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of a bake: maps, images and materials are written to the objects, and files to a folder."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..materials import material, nodes
from ..results import heat, tags
from ..results.write import Outcome
from ..scene import gathering, uv_maps
from ..writing import transaction
from . import images
from .channels import ONE, UDIM

ROWS = 300  # distance of image nodes, in the editor's units
ROUGHNESS = 0.5  # where none is baked
INPUTS = {"COLOUR": "Base Color", "ROUGHNESS": "Roughness", "METALLIC": "Metallic"}  # others have nodes of their own


@dataclass(frozen=True, eq=False)
class _Made:
    """What was written for some objects; the tags are those of the first."""

    objects: list
    contents: dict  # channel: bytes of each tile
    images: dict  # channel: image
    materials: dict  # name of a map: the material that shows the images with it


def write(step, work, options):
    """Writes what a `bake.BakeWork` gave in a `transaction.Step` of its objects; the `Outcome`."""
    groups = [work.baked] if options.images == UDIM else [[one] for one in work.baked]
    made = [_write_group(group) for group in groups]
    step.discard([block for group in made for block in _outdated(group)])
    for group in made:
        _name(group, options)
    if options.folder:
        images.save([group.images for group in made], [group.contents for group in made], options.folder)
    return _outcome(work, made)


def _write_group(group):
    """The `_Made` of a `bake.Baked`, or of several ones with a UDIM tile each."""
    contents = {channel: [one.images[channel] for one in group] for channel in group[0].images}
    made = _Made([], contents, {channel: images.packed(channel, files) for channel, files in contents.items()}, {})
    for tile, one in enumerate(group):
        for name, polygons, uv in zip(one.names, one.polygons, one.atlas.uvs):
            obj = bpy.data.objects[name]
            with transaction.naming(obj):
                _write_object(obj, polygons, uv + np.float32(images.tile_offset(tile)), made)
    return made


def _write_object(obj, polygons, uv, made):
    uv_maps.remember_shown(obj.data)
    name = uv_maps.write_bake_map(obj.data, polygons, uv)
    uv_maps.show_map(obj.data, name)
    heat.refresh(obj)
    if name not in made.materials:
        made.materials[name] = _material("Baked", name, made.images)
    own = material.before_bake(obj)
    for each in (obj, *(other for other in gathering.others(obj) if material.before_bake(other) == own)):
        material.cover_baked(each, made.materials[name])
    made.objects.append(obj)
    obj.data.update()


def _material(name, map_name, images):
    """A new material; images by channel. A height stands beside the others, linked to nothing."""
    made = bpy.data.materials.new(name)
    made[material.OURS] = True
    tree = nodes.Tree.of(made)
    vector, shader = tree.map_vector(map_name, is_attribute=False), tree.shader(ROUGHNESS)
    for row, (channel, image) in enumerate(images.items()):
        picture = tree.node("ShaderNodeTexImage", -600, 400 - ROWS * row, channel.title(), image=image)
        tree.link(vector, picture.inputs["Vector"])
        if channel in INPUTS:
            tree.link(picture.outputs[0], shader.inputs[INPUTS[channel]])
        elif channel == "NORMAL":
            turned = tree.node("ShaderNodeNormalMap", -300, 400 - ROWS * row, uv_map=map_name)
            tree.link(picture.outputs[0], turned.inputs["Color"])
            tree.link(turned.outputs[0], shader.inputs["Normal"])
        if row == 0:
            tree.show_in_solid_view(picture)
    return made


def _outdated(made):
    """Materials of an earlier bake that no object shows any more, and their images."""
    shown = {slot.material for obj in bpy.data.objects for slot in obj.material_slots}
    old = [found for found in tags.find(material.BAKED, made.objects[0], bpy.data.materials) if found not in shown]
    unseen = {node.image for found in old for node in found.node_tree.nodes if node.type == "TEX_IMAGE" and node.image}
    return [*old, *(image for image in unseen if image.users == 1)]


def _name(made, options):
    """Names and tags, once those of an earlier bake are free."""
    first = made.objects[0]
    owner = first.name if options.images not in (ONE, UDIM) or len(made.objects) == 1 else f"{first.name} Atlas"
    for channel, image in made.images.items():
        images.name(image, channel, owner)
    for found in made.materials.values():
        found.name = f"{owner[: images.MOST_NAME]} Baked"
        tags.put(found, material.BAKED, first)


def _outcome(work, made):
    outcome = Outcome()
    of_object = {obj.name: group for group in made for obj in group.objects}
    for one in work.baked:
        side, texels = one.atlas.side, one.atlas.texels
        size = f"{side:,} x {side:,} texels, {texels:.4g} for a metre"
        outcome.done += one.names
        outcome.notes.append(f"{', '.join(one.names)}: {_listed(one.images)} baked into {size}")
        for name in one.names:
            names = {channel.lower(): image.name for channel, image in of_object[name].images.items()}
            outcome.entries.append({"object": name, "side": side, "texels_per_metre": texels, "images": names})
    return outcome


def _listed(channels):
    *first, last = (channel.lower() for channel in channels)
    return f"{', '.join(first)} and {last}" if first else last
