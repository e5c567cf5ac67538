# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that make geometry of a seamless tiling: pieces on its cells, wires along its lines, its cells."""

from functools import partial

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from .. import native
from .mixins import WorkOperator
from .properties import ONCE, items

PIECES = items(
    SCALE="Overlapping scales of a fish or a dragon",
    SHINGLE="Shingles of a roof",
    BRICK="Bricks with gaps",
    PLATE="Plates that fill the surface: hexagons in shifted rows",
    STUD="Pyramids, as on leather",
    RIVET="Heads of rivets",
    RING="Rings of chain mail, each in four others",
    STITCH="Plain knitting, one stitch per cell",
    OBJECT="Your own object; a cell is 1 unit wide",
    COLLECTION="Objects of a collection, at random or in turn",
)
PLACES = items(
    CENTRES="At the centres of the cells",
    CORNERS="At the corners of the cells",
    LOWER_EDGES="On the lower sides of the cells",
    LEFT_EDGES="On the left sides of the cells",
)
DIRECTIONS = items(BOTH="Along both sides of tiles", U="Along u, the rows", V="Along v, across the rows")
ABOUT = {
    "piece": "Pieces to put on the surface",
    "columns": "Number of cells across a tile",
    "rows": "Number of rows of cells in a tile; 0 chooses what suits the piece",
    "place": "Position of a piece in its cell",
    "source": "Name of the object or collection",
    "direction": "Directions of the lines",
    "per_tile": "Lines per tile, the first on the border between tiles",
    "shifted": "Shift every other row by half a cell, as bricks are laid; needs an even number of rows",
    "simple": "Join only the corners of cells, by straight edges: quads, except at poles, branch points and borders. "
    "Off: cells lie on the surface, with a vertex wherever a side crosses an edge",
}


class OnTiling(WorkOperator):
    """What operators share that make something of the tiling of the active mesh. Each defines

    find() : what is looked for, a function of a `holomorph.TiledSurface`
    write(step, obj, found) : makes objects of what was found on the parts; the sentence that tells of it
    """

    @classmethod
    def why_not(cls, context):
        obj = context.view_layer.objects.active
        return "" if obj is not None and obj.type == "MESH" else "Make a mesh object active"

    def prepare(self, context):
        from ..things import geometry

        obj = context.view_layer.objects.active
        self._name = obj.name, obj.library.filepath if obj.library else None
        self._source = geometry.source(obj)

    def make_work(self, progress):
        from ..things import parts

        return parts.PartsWork(*self._source, self.find(), progress)

    def waiting_faces(self):
        return self._source[0].face_count

    def written_objects(self):
        obj = bpy.data.objects.get(self._name)
        return [] if obj is None else [obj]

    def finish(self, step, work, time_has_passed):
        from ..things import geometry

        obj = bpy.data.objects.get(self._name)
        problem = native.sentence(work.error) if work.error else work.problem
        if obj is None or (time_has_passed and not geometry.source(obj)[0].equals(self._source[0])):
            problem = "it changed during the run; please run it again"
        if problem:
            return self.refuse(f"{self._name[0]}: {problem}")
        try:
            self.report({"INFO"}, self.write(step, obj, work.found))
        except ValueError as error:
            return self.refuse(f"{obj.name}: {error}")
        return {"FINISHED"}


class HOLOMORPH_OT_geometry(OnTiling, bpy.types.Operator):
    """Put scales, bricks, chain mail or pieces of your own on the active mesh, one in every cell of its seamless
    tiling. Geometry Nodes instance them, and they follow the mesh; set their size, tilt, randomness and mask in the
    modifier"""

    bl_idname = "object.holomorphic_geometry"
    bl_label = "Geometry on Tiling"

    piece: EnumProperty(name="Piece", description=ABOUT["piece"], items=PIECES, default="SCALE")
    source: StringProperty(name="Object", description=ABOUT["source"], options=ONCE)
    columns: IntProperty(name="Columns", description=ABOUT["columns"], default=4, min=1, soft_max=32, max=1000)
    rows: IntProperty(name="Rows", description=ABOUT["rows"], default=0, min=0, soft_max=32, max=1000)
    place: EnumProperty(name="Place", description=ABOUT["place"], items=PLACES, default="CENTRES")

    def draw_options(self, layout, _obj):
        layout.prop(self, "piece")
        if self.piece in ("OBJECT", "COLLECTION"):
            kind = "objects" if self.piece == "OBJECT" else "collections"
            layout.prop_search(self, "source", bpy.data, kind, text=self.piece.title())
        for name in ("columns", "rows", "place"):
            layout.prop(self, name)

    def prepare(self, context):
        from ..things import points

        self._piece = self._chosen(context.view_layer.objects.active)
        super().prepare(context)
        if not points.is_left_by_turns(self._source[-1], self.columns, self.rows, self.place):
            raise ValueError(points.LEFT_BY_TURNS[self._source[-1]])

    def _chosen(self, obj):
        """A name of a shipped piece, an object or a collection. @throws ValueError"""
        if self.piece not in ("OBJECT", "COLLECTION"):
            return self.piece
        kind = self.piece.lower()
        found = getattr(bpy.data, f"{kind}s").get((self.source, None))
        if found is None:
            raise ValueError(f"choose the {kind} to put on the surface")
        if found == obj or (kind == "collection" and obj.name in found.all_objects):
            raise ValueError(f"{obj.name} cannot be put on itself")
        if kind == "collection" and not found.all_objects:
            raise ValueError(f"the collection {found.name} is empty")
        return found

    def find(self):
        from ..things import pieces, points

        shipped = pieces.PIECES.get(self.piece, pieces.ANY)
        asked = shipped.height, shipped.is_shifted, self.columns, self.rows, self.place, self._source[-1]
        self._arranged = partial(points.arrangement, *asked)
        return partial(points.found, arranged=self._arranged)

    def write(self, step, obj, found):
        from ..things import geometry, points

        values, lattice = points.joined(found)
        if not len(values["tile_u"]):
            raise ValueError("its tiles are so large that no place lies on it: use more columns")
        made = geometry.write_pieces(step, obj, values, self._piece, self._arranged(lattice).cell(lattice))
        return f"{made.name}: {len(made.data.vertices):,} pieces; adjust them in its modifier"


class HOLOMORPH_OT_lines(OnTiling, bpy.types.Operator):
    """Make wires along the lines between the tiles of the active mesh's seamless tiling. They follow the mesh; set
    their thickness in the modifier"""

    bl_idname = "object.holomorphic_lines"
    bl_label = "Lines of Tiling"

    direction: EnumProperty(name="Direction", description=ABOUT["direction"], items=DIRECTIONS, default="BOTH")
    per_tile: IntProperty(name="Lines per Tile", description=ABOUT["per_tile"], default=2, min=1, soft_max=16, max=1000)

    def draw_options(self, layout, _obj):
        layout.prop(self, "direction")
        layout.prop(self, "per_tile")

    def find(self):
        from ..things import wires

        return partial(wires.found, directions=wires.DIRECTIONS[self.direction], per_tile=self.per_tile)

    def write(self, step, obj, found):
        from ..things import geometry, wires

        values = wires.joined(found)
        if not len(values["edges"]):
            raise ValueError("its tiles are so large that no line crosses it: use more lines per tile")
        made = geometry.write_wires(step, obj, values)
        return f"{made.name}: {values['count'].sum():,} lines; set their thickness in its modifier"


class HOLOMORPH_OT_cells(OnTiling, bpy.types.Operator):
    """Make a mesh with one polygon per tile of the active mesh's seamless tiling, and its UVs: for bricks and panels
    to extrude, or as quads"""

    bl_idname = "object.holomorphic_cells"
    bl_label = "Cut along Tiling"

    columns: IntProperty(name="Columns", description=ABOUT["columns"], default=2, min=1, soft_max=16, max=1000)
    rows: IntProperty(
        name="Rows", description="Number of rows of cells in a tile", default=2, min=1, soft_max=16, max=1000
    )
    shifted: BoolProperty(name="Shifted Rows", description=ABOUT["shifted"], default=False)
    simple: BoolProperty(name="Corners Only", description=ABOUT["simple"], default=False)

    def draw_options(self, layout, _obj):
        for name in ("columns", "rows", "shifted", "simple"):
            layout.prop(self, name)

    def prepare(self, context):
        if self.shifted and self.rows % 2:
            raise ValueError("shifted rows need an even number of rows per tile")
        super().prepare(context)

    def find(self):
        from ..things import cut

        return partial(cut.found, per_tile=(self.columns, self.rows), shifted=self.shifted, is_simple=self.simple)

    def write(self, step, obj, found):
        from ..things import cut, geometry

        mesh = cut.joined(found)
        made, quads = geometry.write_cells(step, obj, mesh), int(mesh.faces["is_quad"].sum())
        irregular = f", {mesh.irregular:,} interior vertices without four edges" if self.simple else ""
        return f"{made.name}: {len(made.data.polygons):,} cells, {quads:,} of them complete quads{irregular}"


register, unregister = bpy.utils.register_classes_factory(
    [HOLOMORPH_OT_geometry, HOLOMORPH_OT_lines, HOLOMORPH_OT_cells]
)
