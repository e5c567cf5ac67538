# SPDX-License-Identifier: GPL-3.0-or-later
"""The dials as each object stores them: a property group, which `scene.stored_dials` reads and writes. What is hidden
in it is no dial: numbers in effect where a dial is automatic, what became of the last change, what the map is."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from .. import native
from ..scene import stored_dials
from .mixins import OnMeshes
from .properties import ABOUT, Dials

USUAL_TILES = 100  # of an object without a map, where a number is asked for
ACROSS = 10  # tiles over the largest dimension of an object without a map, where sizes are asked for
NO_DIAL = {"HIDDEN", "SKIP_SAVE"}


def _changed(group, context):
    """Called by Blender after a dial was changed by hand or by a script."""
    if not stored_dials.are_quiet() and not native.problem():
        from . import follow

        follow.changed(group.id_data, context)


def _get_tiles(group):
    return group.tiles or group.made.tiles


def _set_tiles(group, value):
    group.tiles = value


def _get_size(group):
    return group.size or group.made.width


def _set_size(group, value):
    group.size = value


def _get_by_count(group):
    return _get_tiles(group) > 0


def _set_by_count(group, value):
    group.tiles = USUAL_TILES if value else 0


def _get_by_size(group):
    return group.size > 0


def _set_by_size(group, value):
    group.size = (_get_size(group) or max(group.id_data.dimensions) / ACROSS) if value else 0.0


def _stored(**options):
    """The dials as properties of a group."""
    moved = {stored_dials.MOVED: StringProperty(name="Moved Points", description=ABOUT["moved"])}
    every = {**Dials.__annotations__, **moved}.items()
    return {name: one.function(**{**one.keywords, "options": set(), **options}) for name, one in every}


class HOLOMORPH_made_of(bpy.types.PropertyGroup):
    """The dials that a map was made of."""

    __annotations__ = _stored()


class HOLOMORPH_made(bpy.types.PropertyGroup):
    """What is known of the map that was made: what `results.report` writes.

    map : the name of the main map, "" for none
    shape_key : of the mesh; scale_of : the object with the same mesh whose scale was taken, "" for its own
    is_selection : only some faces were mapped
    size, lattice : the fields of a `Request`, as Python writes them
    together : objects whose tiles have one size
    own_turns, averaged : of the texture of the user's that is shown, see `user_texture.Own`; 0 without one
    is_tiled : whether parts have tilings, or pieces of them; turns : the part of a full turn by which these turn
    tiles, width : how many, and how wide they are on the surface; 0 without tilings of whole parts
    points : a vertex and a kind for each, see `results.report`; point_count : how many there are, but for branch points
    movable_count : of these those that can be dragged
    coarse, coarse_vertices : a sentence about the coarse places, and their vertices
    cost : to an eye
    the others : what panels show: whether the map is ready, and why; rows of a name and a value; short lines
    """

    __annotations__ = {
        "dials": PointerProperty(type=HOLOMORPH_made_of),
        **dict.fromkeys(("map", "shape_key", "scale_of", "size", "lattice", "points", "coarse"), StringProperty()),
        **dict.fromkeys(("coarse_vertices", "sentence", "whole", "bake_sentence"), StringProperty()),
        **dict.fromkeys(("numbers", "summary"), StringProperty()),
        **dict.fromkeys(("is_selection", "is_tiled", "is_fit", "is_bake_fit"), BoolProperty()),
        **dict.fromkeys(("together", "turns", "averaged"), IntProperty(default=1)),
        **dict.fromkeys(("own_turns", "tiles", "point_count", "movable_count"), IntProperty()),
        **dict.fromkeys(("width", "cost"), FloatProperty()),
    }

    @property
    def shown_turns(self):
        """2, 4 or 6 where the map turns by that, and the texture of the user's on it does not; else 0."""
        return self.turns if self.own_turns % self.turns else 0


class HOLOMORPH_map(bpy.types.PropertyGroup):
    __annotations__ = {
        **_stored(update=_changed),
        stored_dials.MADE: PointerProperty(type=HOLOMORPH_made, options=NO_DIAL),
        "tiles_shown": IntProperty(
            name="Tiles",
            description="How often the texture repeats on the object; Backspace is automatic",
            min=0,
            soft_max=2000,
            get=_get_tiles,
            set=_set_tiles,
            options=NO_DIAL,
        ),
        "size_shown": FloatProperty(
            name="Size",
            description="How wide one tile is; Backspace is automatic",
            min=0.0,
            subtype="DISTANCE",
            precision=3,
            get=_get_size,
            set=_set_size,
            options=NO_DIAL,
        ),
        "by_count": BoolProperty(
            name="By Number",
            description="Give the number of tiles in place of one that suits the object",
            get=_get_by_count,
            set=_set_by_count,
            options=NO_DIAL,
        ),
        "by_size": BoolProperty(
            name="By Size",
            description="Give the width of one tile in place of the number of tiles",
            get=_get_by_size,
            set=_set_by_size,
            options=NO_DIAL,
        ),
        "refused": StringProperty(options=NO_DIAL),
        "is_waiting": BoolProperty(options=NO_DIAL),
    }


class HOLOMORPH_OT_quarter(OnMeshes, bpy.types.Operator):
    """Turn all rows by 90 degrees"""

    bl_idname = "uv.holomorphic_quarter"
    bl_label = "Quarter Turn"

    def execute(self, context):
        dials = getattr(context.active_object, stored_dials.NAME)
        dials.quarters = (dials.quarters + 1) % 4
        return {"FINISHED"}


_register, _unregister = bpy.utils.register_classes_factory(
    [HOLOMORPH_made_of, HOLOMORPH_made, HOLOMORPH_map, HOLOMORPH_OT_quarter]
)


def register():
    _register()
    setattr(bpy.types.Object, stored_dials.NAME, PointerProperty(type=HOLOMORPH_map))


def unregister():
    delattr(bpy.types.Object, stored_dials.NAME)
    _unregister()
