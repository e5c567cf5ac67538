# SPDX-License-Identifier: GPL-3.0-or-later
"""The dials: what a map is asked to be. Objects store them; operators have the same."""

import math

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

HARD_EDGE = math.radians(40)
EVENNESS = 0.5  # as the package's `Request`, which needs NumPy
MOST_POLES = 16
ONCE = {"SKIP_SAVE"}  # options of properties that Blender does not remember for the next run


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
SOLVERS = (  # as the library names them
    ("auto", "Automatic", "Chosen by size and number of forms"),
    ("direct", "Direct", "Sparse Cholesky factorisation"),
    ("multigrid", "Multigrid", "Linear time and memory"),
    ("paper", "Paper", "The published multiresolution method, on parts with handles or several boundaries"),
)
MAIN_MAPS = (
    ("AUTOMATIC", "Automatic", "Nowhere, or where it shows least if tiles would differ too much in size"),
    ("SEAMLESS", "None", "The texture breaks nowhere, wherever whole tiles fit"),
    ("BALANCED", "One Cut", "One cut through each part, whatever the texture: tiles keep their shape"),
    ("ISLANDS", "Islands", "Flat pieces side by side, cut at your seams and at hard edges: for baking and painting"),
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
TURNS = (
    ("FROM_TEXTURE", "Automatic", "As far as the texture looks the same: a checker by quarters, bricks by halves"),
    *items(
        NONE="The texture never turns: for letters, arrows, scales and all that has one way up",
        HALF="For bricks, planks and all that looks the same upside down",
        QUARTER="For squares, dots, cloth and all that looks the same on its side",
        SIXTH="For images that repeat as hexagons do",
    ),
)
ROWS = items(
    AUTOMATIC="Rows end at hard edges, or run along them, where squares stay about as even",
    ANYWHERE="Squares are as even as can be; edges cut through them",
    ALONG_EDGES="Rows run along hard edges, edges marked sharp, and smooth borders",
    END_AT_EDGES="Rows run along these edges and end there with whole squares",
    MIRRORED="Left and right are alike, on objects that mirror themselves in X or Y",
)
POLES = (
    ("AUTOMATIC", "Automatic", "As many as make the tiles even, where they hardly show"),
    ("COUNT", "Number", "This many on each part, where they show least"),
    ("COARSE", "Where It Is Coarse", "Those of the object's last map, and one at each place that it left coarse"),
    ("SELECTED", "Selected Vertices", "The selected vertices; automatic on parts without any"),
)
LATTICES = (
    ("automatic", "Automatic", "As in your own image where its cells are alike, else square"),
    ("square", "Square", "The texture repeats in rows and columns"),
    ("brick", "Brick", "Each row is shifted by half a tile"),
    ("hex", "Hexagonal", "The texture repeats in three directions, 60 degrees apart"),
)
DIRECTIONS = (
    ("UPRIGHT", "Upright", "Rows run level, so that the texture stands upright"),
    ("NONE", "Any", "The most even direction"),
    *((axis, axis, f"Rows run along the object's {axis} axis as far as possible") for axis in "XYZ"),
    ("EDGES", "Selected Edges", "Rows run along the selected edges as far as possible"),
)
BOUNDARIES = items(
    automatic="Borders of holes lie along rows of the texture, except where that would leave faces without texture",
    straight="Borders of holes lie along rows of the texture",
    free="Borders of holes cut through the texture: more even",
)
UNLINED = {"NONE", "SIXTH"}  # turns of maps without rows at edges
OWN_TEXTURES = {"IMAGE": "images", "MATERIAL": "materials"}  # where Blender has them
ABOUT = {
    "modifiers": "Map the object as its modifiers shape it; where they change its faces, the result is a new object",
    "checker": "Show the texture in place of the object's own materials, which can be brought back",
    "texture": "What the object shows: a pattern, your own image or your own material",
    "source": "Name of the image or material, which is not changed",
    "size": "How wide one tile is; 0: follows from the number of tiles",
    "evenness": "At 0 every tile keeps its shape, at 1 all tiles have one size",
    "turns": "How far the texture may turn from tile to tile: the further, the more even are the tiles",
    "rows": "Where rows of the texture lie on a map that turns by halves or quarters: at hard edges, or anywhere",
    "is_trial": "Keep the map of before where the new one is no better",
    "seams": "Mark the edges where the map is cut; existing marks are kept",
    "main": "Where the texture may break",
    "forms": "Largest number of maps of single forms, besides the main one: one for each handle, more with holes. None "
    "beside a map without seams",
    "shown": "The map that the texture shows: 0 is the main one, 1 that of the first form",
    "density": "How fine the texture is on maps with seams: at 2, squares are half as large. At 1, the parts fill the "
    "UV square together, with equal texel density",
    "equal": "Tiles of all selected objects have one size, and Tiles counts all of them together; off: each for itself",
    "margin": "Empty space between islands, as a share of the UV square; less where there are many",
    "rotation": "Turn the rows by about this angle: a map without seams turns to the nearest that fits",
    "hard_edges": "Cut islands along edges sharper than this and edges marked sharp, as well as along seams. 0: along "
    "seams only",
    "most_stretch": "Cut islands open until lengths change by less than this factor: more seams, but an even texture. "
    "0: no such cuts",
    "selection": "Meaning of the selection. Hidden faces are not mapped in edit mode",
    "residues": "One number for each pole, in the order of selection, for example 1 1 -2; they sum to 0 on a "
    "closed surface, and may be complex (1+0.5j). Empty: chosen automatically",
    "cut": "Cut the maps along your seams where these make each part a disk; else the report says why not",
    "solver": "How the linear systems are solved",
    "squares": "Number of squares, bricks or scales per UV unit on maps with seams, rounded to whole images of the "
    "texture: more are smaller. 0 chooses a number that suits the object's size",
    "shape": "Store the conformal map to the unit sphere (parts without handles and holes) or to the unit disk as a "
    "vector attribute of the vertices, for Geometry Nodes",
    "tiles": "How often the texture repeats, over all objects; 0 chooses a number that suits the largest part",
    "poles": "How many points there are on each part, at which more or fewer tiles meet than elsewhere",
    "pole_group": "A vertex group in which the points stay, where its weight is above 0.5; empty for anywhere",
    "lattice": "How one row of tiles lies upon the next",
    "direction": "Where the rows of the texture run",
    "quarters": "Turn all rows by this many steps of 90 degrees",
    "boundary": "Whether rows follow the borders of holes",
    "repeats": "Images of the texture side by side in one tile",
    "empties": "Put an empty at each point",
    "moved": "The points that were dragged or selected, which stay until they are automatic again",
}


class Dials:
    """A mixin of the dials: `stored_dials` says how objects store them."""

    texture: EnumProperty(name="Texture", description=ABOUT["texture"], items=TEXTURES, default="CHECKER")
    source: StringProperty(name="Source", description=ABOUT["source"])
    checker: BoolProperty(name="Show Texture", description=ABOUT["checker"], default=True)
    tiles: IntProperty(name="Tiles", description=ABOUT["tiles"], default=0, min=0, soft_max=2000)
    size: FloatProperty(name="Size", description=ABOUT["size"], default=0.0, min=0.0, subtype="DISTANCE", precision=3)
    evenness: FloatProperty(
        name="Evenness", description=ABOUT["evenness"], default=EVENNESS, min=0.0, max=1.0, subtype="FACTOR"
    )
    turns: EnumProperty(name="Turns", description=ABOUT["turns"], items=TURNS, default="FROM_TEXTURE")
    direction: EnumProperty(name="Direction", description=ABOUT["direction"], items=DIRECTIONS, default="UPRIGHT")
    quarters: IntProperty(name="Quarter Turns", description=ABOUT["quarters"], default=0, min=0, max=3)
    main: EnumProperty(name="Seams", description=ABOUT["main"], items=MAIN_MAPS, default="AUTOMATIC")
    rotation: FloatProperty(
        name="Rotation",
        description=ABOUT["rotation"],
        subtype="ANGLE",
        unit="ROTATION",
        soft_min=-math.pi,
        soft_max=math.pi,
    )
    rows: EnumProperty(name="Rows", description=ABOUT["rows"], items=ROWS, default="AUTOMATIC")
    lattice: EnumProperty(name="Pattern", description=ABOUT["lattice"], items=LATTICES, default="automatic")
    boundary: EnumProperty(name="Borders", description=ABOUT["boundary"], items=BOUNDARIES, default="automatic")
    poles: EnumProperty(name="Points", description=ABOUT["poles"], items=POLES, default="AUTOMATIC")
    pole_count: IntProperty(name="Number", description="On each part", default=8, min=0, max=MOST_POLES)
    pole_group: StringProperty(name="Only in", description=ABOUT["pole_group"])
    hard_edges: FloatProperty(
        name="Hard Edges", description=ABOUT["hard_edges"], default=0.0, min=0.0, max=math.pi, subtype="ANGLE"
    )
    most_stretch: FloatProperty(name="Most Stretch", description=ABOUT["most_stretch"], min=0.0, soft_max=10.0)
    margin: FloatProperty(name="Margin", description=ABOUT["margin"], default=0.02, min=0.0, soft_max=0.2, max=0.99)
    equal: BoolProperty(name="One Size for All", description=ABOUT["equal"], default=True)
    modifiers: BoolProperty(name="With Modifiers", description=ABOUT["modifiers"], default=False)
    seams: BoolProperty(name="Mark Seams", description=ABOUT["seams"], default=False)
    repeats: IntProperty(name="Repeats", description=ABOUT["repeats"], default=1, min=1, soft_max=8)
    empties: BoolProperty(name="Points as Empties", description=ABOUT["empties"], default=False)
    cut_at_seams: BoolProperty(name="Use Seams as Cut", description=ABOUT["cut"], default=False)
    forms: IntProperty(name="Form Maps", description=ABOUT["forms"], default=8, min=0, soft_max=32)
    shown: IntProperty(name="Shown Map", description=ABOUT["shown"], default=0, min=0, soft_max=8)
    density: FloatProperty(
        name="Density", description=ABOUT["density"], default=1.0, min=1e-4, soft_min=0.1, soft_max=10.0
    )
    checker_scale: FloatProperty(name="Squares", description=ABOUT["squares"], default=0.0, min=0.0, soft_max=200.0)
    solver: EnumProperty(name="Solver", description=ABOUT["solver"], items=SOLVERS, default="auto")
    shape: BoolProperty(name="Store Shape", description=ABOUT["shape"], default=False)


class OfOneRun:
    """A mixin of what an operator is asked for once, and no object stores."""

    use_selection: EnumProperty(
        name="Use Selection", description=ABOUT["selection"], items=SELECTION_USES, default="AUTOMATIC"
    )
    residues: StringProperty(name="Residues", description=ABOUT["residues"])
    is_trial: BoolProperty(name="Trial", description=ABOUT["is_trial"], default=False, options={"HIDDEN"})


# Blender would remember the last values of an operator, while those of the object count.
for _mixin in (Dials, OfOneRun):
    for _one in _mixin.__annotations__.values():
        _one.keywords["options"] = {*ONCE, *_one.keywords.get("options", ())}
