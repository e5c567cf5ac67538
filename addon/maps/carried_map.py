# SPDX-License-Identifier: GPL-3.0-or-later
"""A UV map carried from one mesh to another by the conformal map between them. No bpy here: it runs in a worker
thread."""

from ..native import holomorph
from ..solving import jobs

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
