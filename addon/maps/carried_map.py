# SPDX-License-Identifier: GPL-3.0-or-later
"""A UV map carried from one mesh to another by the conformal map between them. No bpy here: it runs in a worker
thread."""

from .. import native
from ..solving import jobs

MAP_SHARE = 0.6  # of the work, after the structures
FORMLESS = "a sphere or a disk has no forms by which the map could be found, and there are many such maps"


class CarriedMap(jobs.Work):
    """After `run`, `uv` is the map's (#C, 2) UVs on the second of two `comparison.Side`s, `found` the
    `holomorph.Equivalence`; or `error` is one sentence why there is none.

    uv : (#C', 2) on the first one, in the order of its polygons' corners; tolerance : as in `conformally_equivalent`
    """

    def __init__(self, first, second, uv, tolerance, progress=None):
        super().__init__(progress)
        self.uv, self.found, self.error = None, None, ""
        self._sides, self._given, self._tolerance = (first, second), uv, tolerance

    def run(self):
        structures = []
        share = (1 - MAP_SHARE) / len(self._sides)
        for index, side in enumerate(self._sides):
            try:
                structures.append(self._structure(side, self._part(index * share, (index + 1) * share)))
            except native.refusals() as error:
                self.error = f"{side.name}: {native.sentence(error)}"
                return
        try:
            self._carry(*structures)
        except native.refusals() as error:
            self.error = native.sentence(error)

    @staticmethod
    def _structure(side, progress):
        surface = side.surface()
        if surface.genus == 0 and surface.boundary_count <= 1:
            raise native.load().TopologyError(FORMLESS)
        return native.load().conformal_structure(surface, progress=progress)

    def _carry(self, given, taking):
        progress = self._part(1 - MAP_SHARE, 1)
        image = native.load().conformal_map(taking, given, tolerance=self._tolerance, progress=progress)
        first, second = self._sides
        self.found = image.equivalence
        self.uv = second.in_order(image.uv(first.in_order(self._given), progress=self._part(1, 1)))

    def _part(self, begin, end):
        return native.load().progress.scaled(self.ask, begin, end)
