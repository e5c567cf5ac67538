# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the tile operator: as Blender's properties, their drawing, and what they ask for."""

import math

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .properties import MODIFIERS, TEXTURES

MOST_POLES = 16
POLES = (
    ("AUTOMATIC", "Automatic", "As many as the evenness of the texture asks for, where they are hardly seen"),
    ("COUNT", "Number", "So many on each part, placed by themselves"),
    ("KEPT", "As They Are", "Those of the object's last tiling, as they were placed or dragged"),
    (
        "COARSE",
        "Where It Is Coarse",
        "Those of the object's last tiling, and one on each place that it left coarse; automatic without a tiling",
    ),
    ("SELECTED", "Selected Vertices", "The selected vertices; automatic on parts without any"),
)
LATTICES = (
    ("square", "Square", "The texture repeats in rows and columns"),
    ("brick", "Brick", "Each row is shifted by half a tile"),
    ("hex", "Hexagonal", "The texture repeats in three directions, 60 degrees apart"),
)
DIRECTIONS = (
    ("UPRIGHT", "Upright", "The texture stands as the object does: its rows run level, as far as they can"),
    ("NONE", "Any", "The one that is most even"),
    ("X", "X", "Rows run along the object's X axis, as far as they can"),
    ("Y", "Y", "Rows run along the object's Y axis, as far as they can"),
    ("Z", "Z", "Rows run along the object's Z axis, as far as they can"),
    ("EDGES", "Selected Edges", "Rows run along the selected edges, as far as they can"),
)
BOUNDARIES = (
    ("straight", "Straight", "Boundary loops lie along rows of the texture"),
    ("free", "Free", "Boundary loops cut through the texture: more even"),
)
DRAWN = (  # in groups
    ("tiles", "equal", "modifiers", "poles", "pole_count", "pole_group"),
    ("lattice", "direction", "turn", "quarters", "boundary"),
    ("checker", "texture", "repeats", "seams", "empties"),
)


class TileProperties:
    """A mixin for the tile operator."""

    tiles: IntProperty(
        name="Tiles",
        description="Tiles of the texture over each object, about: more are smaller, and less is distorted. "
        "0 chooses a number that suits the shape",
        default=0,
        min=0,
        soft_max=2000,
    )
    poles: EnumProperty(
        name="Poles",
        description="Vertices around which the texture closes up: the more of them, the less squares differ in size "
        "between the body and ears or limbs",
        items=POLES,
        default="AUTOMATIC",
    )
    pole_count: IntProperty(name="Number of Poles", description="On each part", default=8, min=0, max=MOST_POLES)
    # Not remembered for the next object, which has groups of its own.
    pole_group: StringProperty(
        name="Pole Group",
        description="A vertex group: poles are placed only where its weight is above 0.5; empty for anywhere",
        default="",
        options={"SKIP_SAVE"},
    )
    equal: BoolProperty(
        name="Equal Density",
        description="Several objects get the same texels per metre: Tiles is for the active one. Off: for each",
        default=True,
    )
    modifiers: BoolProperty(name="With Modifiers", description=MODIFIERS, default=False, options={"SKIP_SAVE"})
    lattice: EnumProperty(name="Lattice", description="How the texture repeats", items=LATTICES, default="square")
    direction: EnumProperty(
        name="Direction", description="Where the rows of the texture run", items=DIRECTIONS, default="UPRIGHT"
    )
    turn: FloatProperty(
        name="Rotation",
        description="Rotates the texture on the surface, beside the direction, to about this angle: where it closes up",
        subtype="ANGLE",
        unit="ROTATION",
        soft_min=-math.pi,
        soft_max=math.pi,
    )
    quarters: IntProperty(
        name="Quarter Turns", description="Turns the texture by 90 degrees each", default=0, min=0, max=3
    )
    boundary: EnumProperty(name="Boundary", description="What becomes of holes", items=BOUNDARIES, default="straight")
    checker: BoolProperty(
        name="Show Texture",
        description="Show the map by a material; the mesh's own materials stay and can be brought back",
        default=True,
    )
    texture: EnumProperty(name="Texture", description="What the material shows", items=TEXTURES, default="CHECKER")
    repeats: IntProperty(
        name="Repeats", description="Images of the texture side by side in one tile", default=1, min=1, soft_max=8
    )
    seams: BoolProperty(
        name="Mark Seams",
        description="Mark the edges where the map is cut as seams; existing seams are kept",
        default=False,
    )
    empties: BoolProperty(
        name="Poles as Empties", description="Put an empty at each pole and at each branch point", default=False
    )

    def draw_options(self, layout, obj):
        from ..results import tile_report

        tile_report.draw_read_out(layout, obj)
        for group in DRAWN:
            column = layout.column()
            for name in group:
                if name == "pole_group" and obj is not None:
                    column.prop_search(self, name, obj, "vertex_groups")
                elif name != "pole_count" or self.poles == "COUNT":
                    column.prop(self, name)

    def tile_options(self, target):
        """The `tiling.TileOptions` for an object; raises ValueError where nothing is selected that is asked for."""
        from . import tile_choices

        return tile_choices.options(self, target)
