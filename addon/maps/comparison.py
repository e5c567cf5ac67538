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


MAP_SHARE = 0.6  # part of the work, after the structures
FORMLESS = "a sphere or a disk has many such maps, and no forms that single one out"


class CarriedMap(jobs.Work):
    """After `run`, `uv` is the map's (#C, 2) UVs on the second of two `comparison.Side`s, `found` the
    `holomorph.Equivalence`; if there is no `error`.

    uv : (#C', 2) on the first one, in the order of its polygons' corners; tolerance : as in `conformally_equivalent`
    """

    def __init__(self, first, second, uv, tolerance, progress=None):
        super().__init__(progress)
        self.uv, self.found = None, None
        self._sides, self._given, self._tolerance = (first, second), uv, tolerance

    def work(self):
        half = (1 - MAP_SHARE) / 2
        first, second = self._sides
        given = first.checked(lambda surface: _structure(surface, self.watch.part(0, half)))
        taking = second.checked(lambda surface: _structure(surface, self.watch.part(half, 2 * half)))
        progress = self.watch.part(2 * half, 1)
        image = holomorph.conformal_map(taking, given, tolerance=self._tolerance, progress=progress)
        self.found = image.equivalence
        self.uv = second.in_order(image.uv(first.in_order(self._given), progress=self.watch.part(1, 1)))


def _structure(surface, progress):
    if surface.genus == 0 and surface.boundary_count <= 1:
        raise holomorph.TopologyError(FORMLESS)
    return holomorph.conformal_structure(surface, progress=progress)
