# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the maps operator: as Blender's properties, their drawing, and the requests made of them."""

import functools
import math

from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from .. import native

DIALS = 8
HARD_EDGE = math.radians(40)
HARD_EDGES = (
    "Islands are cut along edges that are sharper than this, and those marked sharp, as well as along seams. 0: along "
    "seams alone"
)
MOST_STRETCH = (
    "Islands are cut open, from the place that is stretched or squeezed most to its border, until lengths change by "
    "less than this factor: seams for an even texture. 0: no such cuts"
)
MODIFIERS = (
    "In object mode: map the mesh as the modifiers make it. Where they change its faces, the result becomes an object "
    "of its own and the object is hidden"
)

SELECTION_USES = (
    (
        "AUTOMATIC",
        "Automatic",
        "In edit mode: selected faces alone are mapped. Without any, four selected boundary vertices of a disk become "
        "the corners of a rectangle, other single vertices punctures; edges and what does not fit are no choice",
    ),
    ("FACES", "Faces", "The selected faces are mapped, as a surface with a boundary; the others keep their UVs"),
    (
        "PUNCTURES",
        "Punctures",
        "The texture runs around each selected vertex, and its density grows towards it without end: at least two on "
        "a closed surface, one on a disk",
    ),
    (
        "RECTANGLE",
        "Rectangle",
        "The four selected vertices on the boundary of a disk become the corners of an exact rectangle",
    ),
    ("NONE", "None", "The selection does not matter"),
)
BOUNDARIES = (
    ("natural", "Natural", "Solve on the surface itself: fast"),
    (
        "double_cover",
        "Double Cover",
        "Glue two copies of the surface along the boundary and solve on the closed "
        "double: the same result at more than twice the cost",
    ),
)
SOLVER_TEXTS = {
    "auto": ("Automatic", "By size and number of forms"),
    "direct": ("Direct", "Sparse Cholesky factorisation"),
    "multigrid": ("Multigrid", "Linear time and memory"),
    "paper": ("Paper", "The published multiresolution method, on closed parts with handles: for comparison"),
}
MAIN_MAPS = (
    (
        "AUTOMATIC",
        "Automatic",
        "Seamless on each part where that is no less even; balanced where something else is chosen for a part, or "
        "density, rotation or the forms' shares are set",
    ),
    ("SEAMLESS", "Seamless", "A texture that tiles shows no seam; density, rotation and forms' shares do not matter"),
    ("BALANCED", "Balanced", "The combination of the forms whose density is most even: exactly conformal, with seams"),
    (
        "ISLANDS",
        "Islands",
        "The mesh is cut along the seams that you marked, each part is flattened without shearing, and Blender packs "
        "the parts without overlap: for baking and painting",
    ),
)
TEXTURES = (
    ("CHECKER", "Checker", "Squares"),
    ("NUMBERED", "Numbered", "Coloured tiles from A1 to H8 with arrows: seams, flips and rotations are seen at once"),
    ("BRICKS", "Bricks", "A brick wall"),
    ("SCALES", "Scales", "Scales of a dragon or a fish"),
    ("WEAVE", "Weave", "Woven cloth"),
    ("PLANKS", "Planks", "Wooden boards"),
    ("HEXAGONS", "Hexagons", "Glazed hexagonal tiles"),
)
DRAWN = (  # in groups
    ("main", "hard_edges", "most_stretch", "density", "equal", "margin", "rotation", "forms", "shown"),
    ("checker", "texture", "checker_scale", "seams", "shape"),
    ("use_selection", "modifiers", "residues", "cut_at_seams", "boundary", "solver"),
)
OF_ISLANDS = {"hard_edges", "most_stretch"}


@functools.lru_cache(maxsize=1)
def _items_of(names):
    return [(name, *SOLVER_TEXTS.get(name, (name.title(), ""))) for name in names]


def solver_items(_properties, _context):
    """The library's solvers, the first one the default. Blender keeps no reference to the texts: `_items_of` does."""
    return _items_of(("auto",) if native.problem() else native.load().SOLVERS)


class MapProperties:
    """A mixin for the maps operator."""

    main: EnumProperty(name="Main Map", description="What the main map is", items=MAIN_MAPS, default="AUTOMATIC")
    forms: IntProperty(
        name="Form Maps",
        description="At most so many maps of single forms, besides the main one: one for each handle, more with holes",
        default=8,
        min=0,
        soft_max=32,
    )
    shown: IntProperty(
        name="Shown Map",
        description="The map that the texture shows: 0 is the main one, 1 that of the first form",
        default=0,
        min=0,
        soft_max=8,
    )
    density: FloatProperty(
        name="Density",
        description="How fine the texture is: at 2 squares are half as large. At 1 the parts fill the UV square "
        "together, with equal texel density",
        default=1.0,
        min=1e-4,
        soft_min=0.1,
        soft_max=10.0,
    )
    equal: BoolProperty(
        name="Equal Density",
        description="Several objects get the same texels per metre, that of a tiling if there is one, else that of the "
        "object with the largest map, which fills the UV square. Off: each object fills it",
        default=True,
    )
    margin: FloatProperty(
        name="Margin",
        description="Empty space between connected parts in the UV editor, as a share of the UV square; less where "
        "there are many",
        default=0.02,
        min=0.0,
        max=0.2,
    )
    rotation: FloatProperty(
        name="Rotation",
        description="Turns the squares on the surface, by turning every part of all maps",
        subtype="ANGLE",
        unit="ROTATION",
    )
    hard_edges: FloatProperty(name="Hard Edges", description=HARD_EDGES, min=0.0, max=math.pi, subtype="ANGLE")
    most_stretch: FloatProperty(name="Most Stretch", description=MOST_STRETCH, min=0.0, soft_max=10.0)
    # Not remembered for the next object, which has a selection of its own.
    use_selection: EnumProperty(
        name="Use Selection",
        description="What the selection is. Hidden faces are not mapped in edit mode",
        items=SELECTION_USES,
        default="AUTOMATIC",
        options={"SKIP_SAVE"},
    )
    residues: StringProperty(
        name="Residues",
        description="One number for each puncture, in the order of selection, for example 1 1 -2; they sum to 0 on a "
        "closed surface, and may be complex (1+0.5j). Empty: chosen by themselves",
        default="",
        options={"SKIP_SAVE"},
    )
    modifiers: BoolProperty(name="With Modifiers", description=MODIFIERS, default=False, options={"SKIP_SAVE"})
    cut_at_seams: BoolProperty(
        name="Use Seams as Cut",
        description="Cut the maps along your seams where these make each part a disk; else the report says why not",
        default=False,
    )
    boundary: EnumProperty(
        name="Boundary", description="How surfaces with a boundary are solved", items=BOUNDARIES, default="natural"
    )
    solver: EnumProperty(name="Solver", description="How the linear systems are solved", items=solver_items, default=0)
    amounts: FloatVectorProperty(
        name="Amount",
        description="How much of each form is in the main map: it moves the places where squares are large and small. "
        "At 1 their sizes are most even",
        size=DIALS,
        default=(1.0,) * DIALS,
        soft_min=0.0,
        soft_max=4.0,
    )
    turns: FloatVectorProperty(
        name="Phase",
        description="Turns each form's share in the main map: squares turn and change their size around its handle. "
        "Not on parts with a boundary, which stays straight",
        size=DIALS,
        default=(0.0,) * DIALS,
        subtype="EULER",
        unit="ROTATION",
    )
    checker: BoolProperty(
        name="Show Texture",
        description="Show the map by a material; the mesh's own materials stay and can be brought back",
        default=True,
    )
    texture: EnumProperty(name="Texture", description="What the material shows", items=TEXTURES, default="CHECKER")
    checker_scale: FloatProperty(
        name="Squares",
        description="Squares, bricks, scales ... per UV unit, rounded to whole images of a texture: more are smaller. "
        "0 chooses a number that suits the object's size",
        default=0.0,
        min=0.0,
        soft_max=200.0,
    )
    seams: BoolProperty(
        name="Mark Seams",
        description="Mark the edges where the maps are cut as seams; existing seams are kept",
        default=False,
    )
    shape: BoolProperty(
        name="Store Shape",
        description="Store the conformal map to the unit sphere (parts without handles and holes) or to the unit disk "
        "as a vector attribute of the vertices, for Geometry Nodes",
        default=False,
    )
    form_count: IntProperty(options={"HIDDEN", "SKIP_SAVE"})

    def draw_options(self, layout, _obj):
        for group in DRAWN:
            column = layout.column()
            for name in group:
                if name not in OF_ISLANDS or self.main == "ISLANDS":
                    column.prop(self, name)
        for index in range(min(self.form_count, DIALS) if self.form_count > 1 else 0):  # a single form has no share
            row = layout.row(align=True)
            row.prop(self, "amounts", index=index, text=f"Form {index + 1}")
            row.prop(self, "turns", index=index, text="")

    def request(self):
        """The `targets.Request`; raises ValueError where the residues cannot be read."""
        from ..scene import targets
        from ..solving import choices

        are_islands = self.main == "ISLANDS"
        return targets.Request(
            use=targets.use_of_vertices(self.use_selection),
            faces=targets.use_of_faces(self.use_selection),
            residues=choices.numbers(self.residues),
            cut_at_seams=self.cut_at_seams or are_islands,
            boundary=choices.ISLANDS if are_islands else self.boundary,
            solver=self.solver,
            modifiers=self.modifiers,
            hard_edges=math.degrees(self.hard_edges) if are_islands else 0.0,
            most_stretch=self.most_stretch if are_islands else 0.0,
        )

    def map_options(self):
        from ..maps import maps

        return maps.MapOptions(
            self.forms, self.density, self.rotation, tuple(self.amounts), tuple(self.turns), self.margin, self.main
        )

    def write_options(self):
        from ..results import run

        return run.WriteOptions(self.shown, self.checker, self.texture, self.checker_scale, self.seams, self.shape)
