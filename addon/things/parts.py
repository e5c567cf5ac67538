# SPDX-License-Identifier: GPL-3.0-or-later
"""The tiled parts of an object, and what is found on each. No bpy here: it runs in a worker thread."""

from dataclasses import dataclass, field

import numpy as np

from .. import native
from ..native import holomorph
from ..solving import jobs
from . import tree

FOUND = 0.7  # part of the work until something is found on all parts
NO_TILING = "its UV map is not a seamless tiling: press Seamless Tiling first"


@dataclass
class PartsWork(jobs.Work):
    """Looks for something on every connected part of an object that has a tiling. After `run`, `found` is what `find`
    gave, a part after the other; `problem` is one sentence why there is none, or ""."""

    polygons: object  # mesh_io.Polygons
    uv: np.ndarray  # (#C, 2)
    lattice: str
    turns: int
    find: object  # of a `holomorph.TiledSurface`, with its progress function
    progress: object = None
    found: list = field(default_factory=list)
    problem: str = ""
    parts: tuple = ()  # connected ones, `holomorph.Surface`s

    def __post_init__(self):
        super().__init__(self.progress)

    def work(self):
        refusals = []
        self.parts = components = self.polygons.surface(strict=False).components
        for done, part in enumerate(components):
            ask = self.watch.part(done / len(components) * FOUND, (done + 1) / len(components) * FOUND)
            if not ask(0.0, "tiles"):
                raise holomorph.Cancelled("cancelled during the search for tiles")
            uv = self.uv if part.is_whole else self.uv[part.corner_index]
            try:
                tiled = holomorph.TiledSurface(part, uv, self.lattice, turns=self.turns)
            except holomorph.TopologyError as error:
                refusals.append(native.sentence(error))
                self.skip(part)
                continue
            self.found.append(self.look(tiled, ask))
        if len(refusals) == len(components):
            self.problem = f"{NO_TILING} ({refusals[0]})" if refusals else NO_TILING

    def look(self, tiled, ask):
        return self.find(tiled, ask)

    def skip(self, part):
        """Handles a `holomorph.Surface` that has no tiling: nothing is found there."""


def surface_values(points):
    """Where `holomorph.SurfacePoints` lie, as attributes by name: their positions in the frame of the polygons, and
    what `tree.Followed` needs to find them again."""
    surface = points.tiled.surface
    vertices = surface.vertex_index[surface.triangles[points.triangles]]
    corners = surface.triangle_corners[points.triangles]
    corners = corners if surface.is_whole else surface.corner_index[corners]
    return {
        tree.POSITION: points.positions,
        **{name: vertices[:, k] for k, name in enumerate(tree.VERTICES)},
        **{name: corners[:, k] for k, name in enumerate(tree.CORNERS)},
        tree.BARYCENTRIC: points.barycentric,
    }


def joined(dictionaries):
    """{name: (n, ...)} of several with the same names."""
    return {name: np.concatenate([one[name] for one in dictionaries]) for name in dictionaries[0]}
