# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the maps operators as Blender's properties, and those that the tile operator has, too."""

import functools
import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from .. import native

FORMS = 8  # whose share in the main map can be changed
HARD_EDGE = math.radians(40)
EVENNESS = 0.5  # as `mapped.TileOptions`, which needs NumPy


def items(**texts):
    """The items of an `EnumProperty`, whose labels are their names."""
    return tuple((name, name.replace("_", " ").title(), text) for name, text in texts.items())


SELECTION_USES = items(
    AUTOMATIC="In edit mode: map only the selected faces. If none is selected, four boundary vertices of a disk "
    "become the corners of a rectangle, and other single vertices become poles; anything else, such as edges, is "
    "ignored",
    FACES="The selected faces are mapped, as a surface with a boundary; the others keep their UVs",
    POLES="The texture runs around each selected vertex, finer and finer towards it: select at least two on a closed "
    "surface, one on a disk",
    RECTANGLE="The four selected vertices on the boundary of a disk become the corners of an exact rectangle",
    NONE="Ignore the selection",
)
SOLVER_TEXTS = {
    "auto": ("Automatic", "Chosen by size and number of forms"),
    "direct": ("Direct", "Sparse Cholesky factorisation"),
    "multigrid": ("Multigrid", "Linear time and memory"),
    "paper": ("Paper", "The published multiresolution method, on parts with handles or several boundaries"),
}
MAIN_MAPS = items(
    AUTOMATIC="Seamless on each part where that is at least as even; balanced where you choose something else for a "
    "part, or set density, rotation or the shares of forms",
    SEAMLESS="A texture that tiles shows no seam; density, rotation and the shares of forms have no effect",
    BALANCED="The combination of the forms whose density is most even, with seams; at evenness 0 exactly conformal",
    ISLANDS="The mesh is cut along the seams that you marked, each part is flattened, and Blender packs the parts "
    "without overlap: for baking and painting",
)
TEXTURES = items(
    CHECKER="Squares",
    NUMBERED="Coloured tiles from A1 to H8 with arrows: seams, flips and rotations show at once",
    BRICKS="A brick wall",
    SCALES="Scales of a dragon or a fish",
    WEAVE="Woven cloth",
    PLANKS="Wooden boards",
    HEXAGONS="Glazed hexagonal tiles",
    IMAGE="Your own image; one that is not square keeps its proportions",
    MATERIAL="Your own material: a copy of it reads the map. It is assumed to repeat as its images do",
)
TURNS = items(
    FROM_TEXTURE="As the texture allows, where poles, lattice, rotation and boundary are automatic",
    NONE="The sides of a cut are only shifted: for letters, arrows, scales and all that has one way up",
    HALF="The sides may also turn by a half: for bricks, planks and all that looks the same upside down",
    QUARTER="The sides may also turn by a quarter: for squares, dots, cloth and all that looks the same on its side",
    SIXTH="The sides may also turn by a sixth: for images that repeat as hexagons do",
)
ROWS = items(
    AUTOMATIC="Rows end at hard edges, or run along them, where squares stay about as even",
    ANYWHERE="Squares are as even as can be; edges cut through them",
    ALONG_EDGES="Rows run along hard edges, edges marked sharp, and smooth borders",
    END_AT_EDGES="Rows run along these edges and end there with whole squares",
    MIRRORED="Left and right are alike, on objects that mirror themselves in X or Y",
)
UNLINED = {"NONE", "SIXTH"}  # turns of maps without such rows
OWN_TEXTURES = {"IMAGE": "images", "MATERIAL": "materials"}  # where Blender has them
OF_ISLANDS = {"hard_edges", "most_stretch"}
ABOUT = {
    "modifiers": "In object mode: map the mesh as the modifiers make it. Where they change its faces, the result "
    "becomes an object of its own and the object is hidden",
    "checker": "Show the map by a material; the mesh's own materials stay and can be brought back",
    "texture": "Texture that the material shows",
    "source": "Name of the image or material, which is not changed",
    "size": "Width of one image of the texture on the surface; seamless maps keep it within a tenth, as whole tiles "
    "must fit. 0: follows from the number of tiles or squares",
    "evenness": "0: squares keep their angles but differ in size. 1: they have one size but are sheared. Poles stay "
    "in place when it changes",
    "turns": "By what the texture may turn from one side of a cut to the other: squares are then more even, and there "
    "are no poles. A texture that looks different after the turn shows seams. No effect on islands and maps with seams",
    "rows": "Where rows of the texture lie on a map that turns by halves or quarters: at hard edges, or anywhere",
    "is_trial": "Keep the map of before where the new one is no better",
    "seams": "Mark the edges where the maps are cut as seams; existing seams are kept",
    "main": "Kind of the main map",
    "forms": "Largest number of maps of single forms, besides the main one: one for each handle, more with holes",
    "shown": "The map that the texture shows: 0 is the main one, 1 that of the first form",
    "density": "How fine the texture is: at 2, squares are half as large. At 1, the parts fill the UV square together, "
    "with equal texel density",
    "equal": "Give several objects the same texels per metre: that of a tiling if there is one, else that of the "
    "object with the largest map, which fills the UV square. Off: each object fills it",
    "margin": "Empty space between connected parts in the UV editor, as a share of the UV square; less where there are "
    "many",
    "rotation": "Turn the squares on the surface, by turning every part of all maps",
    "hard_edges": "Cut islands along edges sharper than this and edges marked sharp, as well as along seams. 0: along "
    "seams only",
    "most_stretch": "Cut islands open, from the most stretched or squeezed place to the border, until lengths change "
    "by less than this factor: more seams, but an even texture. 0: no such cuts",
    "selection": "Meaning of the selection. Hidden faces are not mapped in edit mode",
    "residues": "One number for each pole, in the order of selection, for example 1 1 -2; they sum to 0 on a "
    "closed surface, and may be complex (1+0.5j). Empty: chosen automatically",
    "cut": "Cut the maps along your seams where these make each part a disk; else the report says why not",
    "solver": "How the linear systems are solved",
    "amounts": "Share of each form in the main map: it moves the places where squares are large and small. At 1, "
    "their sizes are most even. While you mix forms, Evenness has no effect on parts of more than 20,000 triangles",
    "phases": "Turn each form's share in the main map: squares turn and change size around its handle. No effect on "
    "parts with a boundary, which stays straight",
    "squares": "Number of squares, bricks or scales per UV unit, rounded to whole images of the texture: more are "
    "smaller. 0 chooses a number that suits the object's size",
    "shape": "Store the conformal map to the unit sphere (parts without handles and holes) or to the unit disk as a "
    "vector attribute of the vertices, for Geometry Nodes",
}
# Not remembered for the next object, which has a selection and modifiers of its own.
ONCE = {"SKIP_SAVE"}


@functools.lru_cache(maxsize=1)
def _items_of(names):
    return [(name, *SOLVER_TEXTS.get(name, (name.title(), ""))) for name in names]


def solver_items(_properties, _context):
    """The library's solvers, the first one the default. Blender keeps no reference to the texts: `_items_of` does."""
    return _items_of(("auto",) if native.problem() else native.load().SOLVERS)


def main_property(default):
    return EnumProperty(name="Main Map", description=ABOUT["main"], items=MAIN_MAPS, default=default)


def hard_edges_property(default):
    text = ABOUT["hard_edges"]
    return FloatProperty(name="Hard Edges", description=text, default=default, min=0.0, max=math.pi, subtype="ANGLE")


class SharedProperties:
    """A mixin for operators that make maps: what all of them have, and how it is drawn. Each has

    drawn : names of its properties, in groups
    is_drawn(name) : whether a property has a meaning
    is_tiling : whether it makes tilings alone
    may_tile() : whether tilings are made, or tried
    """

    modifiers: BoolProperty(name="With Modifiers", description=ABOUT["modifiers"], default=False, options=ONCE)
    checker: BoolProperty(name="Show Texture", description=ABOUT["checker"], default=True)
    texture: EnumProperty(name="Texture", description=ABOUT["texture"], items=TEXTURES, default="CHECKER")
    source: StringProperty(name="Source", description=ABOUT["source"], default="")
    size: FloatProperty(name="Size", description=ABOUT["size"], default=0.0, min=0.0, subtype="DISTANCE", precision=3)
    found: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    evenness: FloatProperty(name="Evenness", description=ABOUT["evenness"], default=EVENNESS, min=0.0, max=1.0)
    turns: EnumProperty(name="Turns", description=ABOUT["turns"], items=TURNS, default="FROM_TEXTURE")
    rows: EnumProperty(name="Rows", description=ABOUT["rows"], items=ROWS, default="AUTOMATIC")
    seams: BoolProperty(name="Mark Seams", description=ABOUT["seams"], default=False)
    is_trial: BoolProperty(name="Trial", description=ABOUT["is_trial"], default=False, options={"HIDDEN", "SKIP_SAVE"})
    form_count: IntProperty(options={"HIDDEN", "SKIP_SAVE"})
    tile_count: IntProperty(options={"HIDDEN", "SKIP_SAVE"})

    def is_drawn(self, name):
        hidden = {"source": self.texture not in OWN_TEXTURES, "rows": self.turns in UNLINED}
        return not hidden.get(name, False)

    def draw_options(self, layout, obj):
        for group in self.drawn:
            column = layout.column()
            for name in filter(self.is_drawn, group):
                if name == "pole_group" and obj is not None:
                    column.prop_search(self, name, obj, "vertex_groups")
                elif name == "source":
                    column.prop_search(self, name, bpy.data, OWN_TEXTURES[self.texture], text=self.texture.title())
                    if self.found:
                        column.label(text=self.found)
                else:
                    column.prop(self, name)


class MapProperties(SharedProperties):
    """A mixin for the maps operators."""

    is_tiling = False
    drawn = (
        (
            "main",
            "evenness",
            "turns",
            "rows",
            "hard_edges",
            "most_stretch",
            "density",
            "equal",
            "margin",
            "rotation",
            "forms",
            "shown",
        ),
        ("checker", "texture", "source", "size", "checker_scale", "seams", "shape"),
        ("use_selection", "modifiers", "residues", "cut_at_seams", "solver"),
    )
    main: main_property("AUTOMATIC")
    forms: IntProperty(name="Form Maps", description=ABOUT["forms"], default=8, min=0, soft_max=32)
    shown: IntProperty(name="Shown Map", description=ABOUT["shown"], default=0, min=0, soft_max=8)
    density: FloatProperty(
        name="Density", description=ABOUT["density"], default=1.0, min=1e-4, soft_min=0.1, soft_max=10.0
    )
    equal: BoolProperty(name="Equal Density", description=ABOUT["equal"], default=True)
    margin: FloatProperty(name="Margin", description=ABOUT["margin"], default=0.02, min=0.0, soft_max=0.2, max=0.99)
    rotation: FloatProperty(name="Rotation", description=ABOUT["rotation"], subtype="ANGLE", unit="ROTATION")
    hard_edges: hard_edges_property(0.0)
    most_stretch: FloatProperty(name="Most Stretch", description=ABOUT["most_stretch"], min=0.0, soft_max=10.0)
    use_selection: EnumProperty(
        name="Use Selection", description=ABOUT["selection"], items=SELECTION_USES, default="AUTOMATIC", options=ONCE
    )
    residues: StringProperty(name="Residues", description=ABOUT["residues"], default="", options=ONCE)
    cut_at_seams: BoolProperty(name="Use Seams as Cut", description=ABOUT["cut"], default=False)
    solver: EnumProperty(name="Solver", description=ABOUT["solver"], items=solver_items, default=0)
    amounts: FloatVectorProperty(
        name="Amount", description=ABOUT["amounts"], size=FORMS, default=(1.0,) * FORMS, soft_min=0.0, soft_max=4.0
    )
    phases: FloatVectorProperty(
        name="Phase", description=ABOUT["phases"], size=FORMS, default=(0.0,) * FORMS, subtype="EULER", unit="ROTATION"
    )
    checker_scale: FloatProperty(name="Squares", description=ABOUT["squares"], default=0.0, min=0.0, soft_max=200.0)
    shape: BoolProperty(name="Store Shape", description=ABOUT["shape"], default=False)

    def may_tile(self):
        return self.main != "BALANCED"

    def is_drawn(self, name):
        return super().is_drawn(name) and (name not in OF_ISLANDS or self.main == "ISLANDS")

    def draw_options(self, layout, obj):
        super().draw_options(layout, obj)
        for index in range(min(self.form_count, FORMS) if self.form_count > 1 else 0):  # a single form has no share
            row = layout.row(align=True)
            row.prop(self, "amounts", index=index, text=f"Form {index + 1}")
            row.prop(self, "phases", index=index, text="")
