# SPDX-License-Identifier: GPL-3.0-or-later
"""A material that shows a map, put over the mesh's own materials without touching them; and views that show it.

The material slots are linked to the object while it is shown, so the mesh keeps its own materials and
`uncover` brings them back.
"""

import re
from dataclasses import dataclass

import bpy
import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..scene import mesh_io
from . import nodes, textures, user_texture
from .nodes import OURS
from .patterns import TEXTURES
from .user_texture import IMAGE, MATERIAL, Own

CHECKER = "CHECKER"
CHECKER_ACROSS = 32  # squares that span an object where no number is asked for
CHECKER_CELLS = 2  # squares of the checker after which it repeats
OWN_ACROSS = 8  # images of the user's that span an object where no number is asked for
REPLACED = "holomorph_replaced_materials"  # custom property: slot index -> material linked to the object before
BEFORE_BAKE = "holomorph_before_bake"  # custom property: slot index -> material that a baked one took the place of
EMPTY = 0  # instead of a material: the slot was linked to the object, and empty
AVERAGED = " averaged"  # end of what those show that are averaged over turns
SHOWS = "holomorph_shows"  # custom property of those that show a texture of the user's: which one, and of which map
LOOK = "holomorph_look"  # custom property of those that show a map: `Look.numbers`
BAKED = "holomorph_baked_of"  # and those of them that show baked images: name of the object


def cells(texture):
    """How many squares, bricks, scales ... there are across an image of a texture."""
    if texture in (IMAGE, MATERIAL):
        return 1
    return CHECKER_CELLS if texture == CHECKER else TEXTURES[texture].cells


def across(texture):
    """How many squares, bricks, scales ... span an object where no number is asked for."""
    if texture in (IMAGE, MATERIAL):
        return OWN_ACROSS
    return CHECKER_ACROSS if texture == CHECKER else TEXTURES[texture].across


CHECKER_TURNS = 4  # the checker looks the same after a quarter turn, about the middle of a square


def turns(texture, own=None):
    """2, 4 or 6: a texture looks the same after this part of a full turn; 1: after none.

    own : `user_texture.Own` of the user's
    """
    if own is not None:
        return own.turns
    return CHECKER_TURNS if texture == CHECKER else TEXTURES[texture].turns


@dataclass(frozen=True)
class Look:
    """What is shown of a map."""

    texture: str  # CHECKER, one of `patterns.TEXTURES`, or the kind of `own`
    cells: float  # squares, bricks, scales ... across a UV unit
    unit_length: float  # on the surface, of a UV unit
    is_tiling: bool = False  # whether the map is cut by whole units: such a map has a material of its own
    own: Own | None = None  # the texture of the user's
    is_turned: bool = False  # whether the sides of its cuts turn: about the corners of tiles, where the centre lies

    @property
    def numbers(self):
        """Equal where materials that show the same look the same."""
        if self.own is None:
            return repr(self.cells if self.texture == CHECKER else (self.repeats, self.unit_length))
        return repr((self.repeats, self.own))

    @property
    def repeats(self):
        """Images per UV unit: whole numbers, so that they fit where a map is cut by whole units."""
        return max(1, round(self.cells / cells(self.texture)))


def showing(map_name, is_attribute, look, objects=()):
    """The material that shows `map_name` to these objects: one with this look; or one that no mesh but theirs shows,
    adjusted; or a new one. One that shows a material of the user's is a copy of that as it is now."""
    make = _showing_ours if look.own is None else _showing_own
    material = make(map_name, is_attribute, look, objects)
    material[LOOK] = look.numbers
    return material


def _showing_ours(map_name, is_attribute, look, objects):
    name = f"{map_name} {textures.label(look.texture)}" + (" (attribute)" if is_attribute else "")
    name += " (turned)" if look.is_turned else " (tiling)" if look.is_tiling else ""
    numbered = re.compile(rf"{re.escape(name)}(\.\d+)?")
    material = _free([m for m in _ours() if numbered.fullmatch(m.name)], look, objects)
    is_new = material is None
    if is_new:
        material = bpy.data.materials.new(name)
        material[OURS] = True
    if look.texture == CHECKER:
        if is_new:
            nodes.build_checker(material, map_name, is_attribute)
        nodes.adjust_checker(material, look.cells, look.is_turned)
    else:
        if is_new:
            nodes.build_texture(material, look.texture, map_name, is_attribute)
        nodes.adjust_texture(material, look.texture, look.repeats, look.unit_length)
    return material


def _showing_own(map_name, is_attribute, look, objects):
    own, block = look.own, look.own.block
    shows = f"{own.kind} {own.name} {map_name} {is_attribute} {look.is_tiling}{' turned' * look.is_turned}"
    shows += AVERAGED * (own.averaged != 1)
    if own.kind == MATERIAL:
        material = block.copy()
        material.use_fake_user = False
        user_texture.redirect(material.node_tree, map_name, is_attribute, look.repeats, own)
    else:
        ours = [m for m in _ours() if m.get(SHOWS) == shows]
        material = own.averaged == 1 and _free(ours, look, objects) or bpy.data.materials.new("")
        if OURS not in material:
            user_texture.build_image(material, map_name, is_attribute, look.repeats, own)
        user_texture.adjust(material, look.repeats, own)
    if OURS not in material:
        material.name = _free_name(f"{map_name} {own.name}")
        material[OURS], material[SHOWS] = True, shows
    return material


def _ours():
    return [m for m in bpy.data.materials if OURS in m and m.library is None and m.node_tree is not None]


def _free(found, look, objects):
    """The first of these materials that has the look, or that can get it, as no other mesh than those of the objects
    shows it; None where there is none."""
    alike = next((material for material in found if material.get(LOOK) == look.numbers), None)
    if alike is not None or not found:
        return alike
    meshes = {obj.data for obj in objects}
    shown = set().union(*(_shown(obj) for obj in bpy.data.objects if obj.data not in meshes))
    return next((material for material in found if material not in shown), None)


def _shown(obj):
    """The materials of an object, and those that baked ones took the place of."""
    own = {slot.material for slot in obj.material_slots}
    return own.union(getattr(obj.data, "materials", ()), dict(obj.get(BEFORE_BAKE, {})).values())


def _free_name(wanted):
    """Blender would give another material's name away."""
    names = (wanted, *(f"{wanted}.{number:03}" for number in range(1, len(bpy.data.materials) + 1)))
    return next(name for name in names if bpy.data.materials.get((name, None)) is None)


def unused_copies():
    """Copies of materials of the user's, and those with groups of nodes, that no object shows any more; and these."""
    shown = ((m, m.get(SHOWS, "")) for m in bpy.data.materials if m.library is None)
    copies = {m for m, shows in shown if shows.startswith(MATERIAL) or shows.endswith(AVERAGED)}
    for obj in bpy.data.objects if copies else ():
        copies -= _shown(obj)
    return [block for material in copies for block in (material, *user_texture.groups(material.node_tree))]


def cover(obj, material):
    """Shows `material` in every slot of `obj`; the mesh's own materials stay where they are."""
    if not obj.material_slots:
        obj.data.materials.append(material)
        return
    obj.pop(BEFORE_BAKE, None)
    replaced = dict(obj.get(REPLACED, {}))
    for index, slot in enumerate(obj.material_slots):
        if is_ours(slot.material):
            if slot.material != material:  # Blender takes milliseconds to write it
                slot.material = material
            continue
        if slot.link == "OBJECT":
            replaced[str(index)] = slot.material or EMPTY
        slot.link = "OBJECT"
        slot.material = material
    if replaced:
        obj[REPLACED] = replaced


def uncover(obj):
    """Brings back what `cover` covered; returns whether there was something."""
    found = is_covered(obj)
    replaced = obj.get(REPLACED, {})
    for index, slot in enumerate(obj.material_slots):
        if not is_ours(slot.material):
            continue
        if slot.link == "OBJECT":
            before = replaced.get(str(index))
            slot.material = None if before == EMPTY else before
            slot.link = "DATA" if before is None else "OBJECT"
    if len(obj.data.materials) == 1 and is_ours(obj.data.materials[0]):
        _clear(obj.data)
    if REPLACED in obj:
        del obj[REPLACED]
    return found


def before_bake(obj):
    """What the slots show, or showed before images were baked."""
    before = obj.get(BEFORE_BAKE, {})
    shown = enumerate(slot.material for slot in obj.material_slots)
    shown = [before.get(str(index), material) if is_baked(material) else material for index, material in shown]
    return [None if material == EMPTY else material for material in shown]


def cover_baked(obj, material):
    """Shows a material of baked images in every slot, until `unbake`."""
    before = {str(index): shown or EMPTY for index, shown in enumerate(before_bake(obj))}
    cover(obj, material)
    obj[BEFORE_BAKE] = before


def unbake(obj):
    """Brings back what `cover_baked` covered: a material that shows a map, else the own ones; returns whether there was
    something."""
    found = any(is_baked(slot.material) for slot in obj.material_slots)
    before = before_bake(obj) if found else []
    if all(map(is_ours, before)):
        for slot, shown in zip(obj.material_slots, before):
            slot.material = shown
    else:
        uncover(obj)
    obj.pop(BEFORE_BAKE, None)
    return found


def _clear(mesh):
    """Takes all slots away; the faces keep their numbers of slots, which Blender sets to 0."""
    numbers = Values(mesh.polygons, "material_index", np.int32)
    before = mesh_io.read_values(numbers)
    mesh.materials.clear()
    mesh_io.write_values(numbers, before)


def is_covered(obj):
    return any(is_ours(slot.material) for slot in obj.material_slots)


def is_ours(material):
    return material is not None and OURS in material


def is_baked(material):
    """Whether it shows baked images, and so is more than a look at a map."""
    return material is not None and BAKED in material


WITHOUT_TEXTURE = {"SOLID", "WIREFRAME"}  # kinds of shading
SOLID_VIEW, MATERIAL_VIEW = "SOLID", "MATERIAL"  # kinds that show an image over the UV square, and a material as it is
COLOUR = "TEXTURE"  # what the colour of `SOLID_VIEW` is
# Custom property of a screen: index of an area -> kind and colour as they were, kind now.
SHADING_BEFORE = "holomorph_shading"


def show_in_views(window, shown=SOLID_VIEW):
    """Sets one of these kinds of shading in the views that would not show a texture; the others stay."""
    before = dict(window.screen.get(SHADING_BEFORE, {}))
    for index, shading in _views(window):
        kind = shading.type
        if kind in WITHOUT_TEXTURE and (shown, kind, shading.color_type) != (SOLID_VIEW, SOLID_VIEW, COLOUR):
            shading.type = SOLID_VIEW  # first: the colours that there are depend on it
            before[index] = [*(before.get(index) or [kind, shading.color_type])[:2], shown]
            shading.color_type = COLOUR
            shading.type = shown
    if before:
        window.screen[SHADING_BEFORE] = before


def restore_views(window):
    """Takes back what `show_in_views` changed, except in views whose shading was chosen anew since."""
    before = dict(window.screen.get(SHADING_BEFORE, {}))
    for index, shading in _views(window):
        kind, colour, shown = before.get(index, [None] * 3)
        if shading.type == shown and (shown == MATERIAL_VIEW or shading.color_type == COLOUR):
            shading.type = SOLID_VIEW
            shading.color_type = colour
            shading.type = kind
    if before:
        del window.screen[SHADING_BEFORE]


def restore_without_textures(context):
    """Restores the window's views once no mesh shows a texture of ours."""
    meshes = [obj for obj in compatibility.objects_in(context.view_layer) if obj.type == "MESH"]
    if context.window is not None and not any(is_covered(obj) for obj in meshes):
        restore_views(context.window)


def _views(window):
    """(index as text, shading) of each 3D view."""
    areas = enumerate(window.screen.areas)
    return [(str(index), area.spaces.active.shading) for index, area in areas if area.type == "VIEW_3D"]
