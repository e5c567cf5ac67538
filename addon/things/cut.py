# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells of a tiling as polygons. No bpy here."""

from dataclasses import dataclass

import numpy as np

from ..native import holomorph

REGULAR = 4  # edges at a vertex inside


@dataclass(frozen=True)
class CutMesh:
    """Polygons of all parts, corners in their order."""

    vertices: np.ndarray  # (#V, 3) in the frame of the polygons that were cut
    corner_vertices: np.ndarray  # (#C,)
    face_offsets: np.ndarray  # (#F + 1,)
    uv: np.ndarray  # (#C, 2)
    faces: dict  # name: (#F,) of each
    is_corner: np.ndarray  # (#C,) of a tile

    @property
    def irregular(self):
        """How many vertices inside have another number of edges than `REGULAR`, or two as in the middle of a side."""
        sides = holomorph.mesh.edges.polygon_sides(self)
        keys, first, count = np.unique(
            holomorph.mesh.edges.edge_keys(sides, len(self.vertices)), return_index=True, return_counts=True
        )
        ends = sides[first]
        edges = np.bincount(ends.ravel(), minlength=len(self.vertices))
        edges[ends[count == 1].ravel()] = REGULAR  # on the border
        is_needed = edges != 2
        is_needed[self.corner_vertices[self.is_corner]] = True
        return int(np.count_nonzero((edges != REGULAR) & is_needed))

    def mirrored(self):
        """The same polygons the other way round."""
        starts, ends = self.face_offsets[:-1], self.face_offsets[1:]
        corners = np.arange(len(self.corner_vertices))
        back = np.repeat(starts + ends - 1, ends - starts) - corners
        turned = self.corner_vertices[back], self.face_offsets, self.uv[back], self.faces, self.is_corner[back]
        return CutMesh(self.vertices, *turned)


def found(tiled, progress, per_tile, shifted, is_simple):
    """The `holomorph.Cells` of a `holomorph.TiledSurface`; (columns, rows) in each tile."""
    cells = tiled.cells(per_tile, shifted, progress)
    return cells.simplified() if is_simple else cells


def joined(cells):
    """The `CutMesh` of the `holomorph.Cells` of all parts."""
    vertices = np.cumsum([0, *(len(one.vertices) for one in cells)])
    sizes = np.concatenate([np.diff(one.face_offsets) for one in cells])
    corners = [one.corner_vertices + begin for one, begin in zip(cells, vertices)]
    tiles = np.concatenate([one.tiles for one in cells])
    return CutMesh(
        np.concatenate([one.vertices for one in cells]),
        np.concatenate(corners).astype(np.int32),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        np.concatenate([one.uv for one in cells]),
        {"tile_u": tiles[:, 0], "tile_v": tiles[:, 1], "is_quad": np.concatenate([one.is_quad for one in cells])},
        np.concatenate([one.is_corner for one in cells]),
    )
