# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two meshes are conformally equivalent. No bpy here: it runs in a worker thread."""

from dataclasses import dataclass, replace

from .. import native
from ..native import holomorph
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
        if not self.is_mirrored:
            return self.polygons.surface()
        return replace(self.polygons, corner_vertices=corners[::-1], face_offsets=offsets[-1] - offsets[::-1]).surface()

    def checked(self, make):
        """What is made of its surface; a refusal names the object."""
        try:
            return make(self.surface())
        except holomorph.Error as error:
            raise type(error)(f"{self.name}: {native.sentence(error)}") from error

    def in_order(self, values):
        """Values at the polygons' corners in the order of the surface's, and the reverse."""
        return values[::-1] if self.is_mirrored else values


class Comparison(jobs.Work):
    """After `run`, `found` is the `holomorph.Equivalence`, if there is no `error`."""

    def __init__(self, sides, progress=None):
        super().__init__(progress)
        self.found, self._sides = None, sides

    def work(self):
        surfaces = [side.checked(_connected) for side in self._sides]
        self.found = holomorph.conformally_equivalent(*surfaces, progress=self.watch)


def _connected(surface):
    surface.require_connected()
    return surface
