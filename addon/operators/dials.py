# SPDX-License-Identifier: GPL-3.0-or-later
"""The dials as each object stores them: a property group, which `scene.stored_dials` reads and writes. What is hidden
in it is no dial: numbers in effect where a dial is automatic, and what became of the last change."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

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


def _in_effect(group):
    """The `stored.Found` of the object."""
    from ..results import report, stored

    return stored.found(group.id_data.get(report.PROPERTY))


def _get_tiles(group):
    return group.tiles or (0 if native.problem() else _in_effect(group).tiles)


def _set_tiles(group, value):
    group.tiles = value


def _get_size(group):
    return group.size or (0.0 if native.problem() else _in_effect(group).width)


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


def _stored(one):
    """A property of the group, of one of the mixin."""
    return one.function(**{**one.keywords, "options": set(), "update": _changed})


class HOLOMORPH_map(bpy.types.PropertyGroup):
    __annotations__ = {
        **{name: _stored(one) for name, one in Dials.__annotations__.items()},
        stored_dials.MOVED: StringProperty(name="Moved Points", description=ABOUT["moved"], update=_changed),
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


def register():
    bpy.utils.register_class(HOLOMORPH_map)
    bpy.utils.register_class(HOLOMORPH_OT_quarter)
    setattr(bpy.types.Object, stored_dials.NAME, bpy.props.PointerProperty(type=HOLOMORPH_map))


def unregister():
    delattr(bpy.types.Object, stored_dials.NAME)
    bpy.utils.unregister_class(HOLOMORPH_OT_quarter)
    bpy.utils.unregister_class(HOLOMORPH_map)
