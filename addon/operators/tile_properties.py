# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the tile operator: as Blender's properties, their drawing, and what they ask for."""

import math

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .properties import ONCE, SharedProperties, items

MOST_POLES = 16
POLES = (
    ("AUTOMATIC", "Automatic", "As many as an even texture needs, where they hardly show"),
    ("COUNT", "Number", "This many on each part, placed automatically"),
    ("KEPT", "As They Are", "Those of the object's last tiling, as they were placed or dragged"),
    (
        "COARSE",
        "Where It Is Coarse",
        "Those of the object's last tiling, and one at each place that it left coarse; automatic without a tiling",
    ),
    ("SELECTED", "Selected Vertices", "The selected vertices; automatic on parts without any"),
)
LATTICES = (
    ("automatic", "Automatic", "Taken from your own image where its cells are alike, else square"),
    ("square", "Square", "The texture repeats in rows and columns"),
    ("brick", "Brick", "Each row is shifted by half a tile"),
    ("hex", "Hexagonal", "The texture repeats in three directions, 60 degrees apart"),
)
DIRECTIONS = (
    ("UPRIGHT", "Upright", "The texture stands upright: its rows run level as far as possible"),
    ("NONE", "Any", "The most even direction"),
    *((axis, axis, f"Rows run along the object's {axis} axis as far as possible") for axis in "XYZ"),
    ("EDGES", "Selected Edges", "Rows run along the selected edges as far as possible"),
)
BOUNDARIES = items(
    automatic="Borders of holes lie along rows of the texture, except where that would leave faces without texture",
    straight="Borders of holes lie along rows of the texture",
    free="Borders of holes cut through the texture: more even",
)
ABOUT = {
    "tiles": "Approximate number of tiles over all objects: more tiles are smaller and less distorted. 0 chooses a "
    "number that suits the largest part",
    "poles": "Vertices around which the texture closes up: the more there are, the less squares differ in size "
    "between the body and ears or limbs",
    "pole_group": "A vertex group: poles are placed only where its weight is above 0.5; empty for anywhere",
    "equal": "Give several objects the same texels per metre: Tiles counts for all of them together. Off: for each",
    "lattice": "How the texture repeats",
    "direction": "Where the rows of the texture run",
    "turn": "Rotate the texture from its direction by about this angle: to the nearest at which it closes up",
    "quarters": "Turn the texture by this many steps of 90 degrees",
    "boundary": "Treatment of holes",
    "repeats": "Images of the texture side by side in one tile",
    "empties": "Put an empty at each pole and at each branch point",
}


class TileProperties(SharedProperties):
    """A mixin for the tile operator."""

    is_tiling = True
    drawn = (
        ("tiles", "evenness", "turns", "rows", "equal", "modifiers", "poles", "pole_count", "pole_group"),
        ("lattice", "direction", "turn", "quarters", "boundary"),
        ("checker", "texture", "source", "size", "repeats", "seams", "empties"),
    )
    tiles: IntProperty(name="Tiles", description=ABOUT["tiles"], default=0, min=0, soft_max=2000)
    poles: EnumProperty(name="Poles", description=ABOUT["poles"], items=POLES, default="AUTOMATIC")
    pole_count: IntProperty(name="Number of Poles", description="On each part", default=8, min=0, max=MOST_POLES)
    pole_group: StringProperty(name="Pole Group", description=ABOUT["pole_group"], default="", options=ONCE)
    equal: BoolProperty(name="Equal Density", description=ABOUT["equal"], default=True)
    lattice: EnumProperty(name="Lattice", description=ABOUT["lattice"], items=LATTICES, default="automatic")
    direction: EnumProperty(name="Direction", description=ABOUT["direction"], items=DIRECTIONS, default="UPRIGHT")
    turn: FloatProperty(
        name="Rotation",
        description=ABOUT["turn"],
        subtype="ANGLE",
        unit="ROTATION",
        soft_min=-math.pi,
        soft_max=math.pi,
    )
    quarters: IntProperty(name="Quarter Turns", description=ABOUT["quarters"], default=0, min=0, max=3)
    boundary: EnumProperty(name="Boundary", description=ABOUT["boundary"], items=BOUNDARIES, default="automatic")
    repeats: IntProperty(name="Repeats", description=ABOUT["repeats"], default=1, min=1, soft_max=8)
    empties: BoolProperty(name="Poles as Empties", description=ABOUT["empties"], default=False)

    def may_tile(self):
        return True

    def is_drawn(self, name):
        hidden = {"pole_count": self.poles != "COUNT", "tiles": self.size > 0}
        return super().is_drawn(name) and not hidden.get(name, False)

    def draw_options(self, layout, obj):
        draw_tiling(layout, obj)
        if self.tiles == 0 and self.tile_count:
            layout.label(text=f"Tiles: {self.tile_count:,} chosen automatically")
        super().draw_options(layout, obj)


def draw_tiling(layout, obj):
    """What is told of the tiling of an object or None in a redo panel."""
    from ..results import report, stored

    lines = stored.tiling_summary(obj.get(report.PROPERTY)) if obj is not None else []
    if lines:
        column = layout.box().column(align=True)
        for line in lines:
            column.label(text=line)
