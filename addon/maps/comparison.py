# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two meshes are conformally equivalent. No bpy here: it runs in a worker thread."""

from dataclasses import dataclass

from .. import native
from ..solving import jobs


@dataclass(frozen=True)
class Side:
    """One of the two objects; `is_mirrored`: its matrix turns it inside out, as a negative scale does."""

    name: str
    polygons: object
    is_mirrored: bool

    def surface(self):
        """Its `holomorph.Surface`, oriented as it is seen."""
        corners, offsets = self.polygons.corner_vertices, self.polygons.face_offsets
        if self.is_mirrored:
            corners, offsets = corners[::-1], offsets[-1] - offsets[::-1]
        return native.load().Surface.from_polygons(self.polygons.vertices, corners, offsets)

    def in_order(self, values):
        """Values at the polygons' corners in the order of the surface's, and the reverse."""
        return values[::-1] if self.is_mirrored else values


class Comparison(jobs.Work):
    """After `run`, `found` is the `holomorph.Equivalence`, or `error` one sentence why there is none."""

    def __init__(self, sides, progress=None):
        super().__init__(progress)
        self.found, self.error = None, ""
        self._sides = sides

    def run(self):
        surfaces = []
        for side in self._sides:
            try:
                surface = side.surface()
                surface.require_connected()
            except native.refusals() as error:
                self.error = f"{side.name}: {native.sentence(error)}"
                return
            surfaces.append(surface)
        try:
            self.found = native.load().conformally_equivalent(*surfaces, progress=self.ask)
        except native.refusals() as error:
            self.error = native.sentence(error)
