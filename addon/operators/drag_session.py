# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiling while its poles are dragged: what there was, what comes of a move, and its end. No events in here."""

from dataclasses import replace
from functools import partial

import numpy as np

from .. import native
from ..maps import tiling
from ..results import report, tile_report, tile_run
from ..scene import mesh_io, targets
from ..solving import jobs
from . import tile_choices

AGAIN = "run Seamless Tiling again"


class Session:
    """Poles are counted as in the report: part by part."""

    def __init__(self, obj):
        """Takes up the tiling that the report tells of. @throws ValueError where there is none, or no longer"""
        stored = obj.get(report.PROPERTY)
        if report.parsed(stored).get("is_selection"):
            raise ValueError(f"{obj.name}: poles are dragged where a whole mesh was tiled, not selected faces")
        dials = report.parsed(stored).get("dials", {})
        self.target = targets.collect([obj])[0]
        self._options = tile_report.asked_again(stored, tile_choices.allowed(dials.get("pole_group", ""), obj))
        if self._options is None or self.target.refused or mesh_io.main_map(obj.data) not in obj.data.uv_layers:
            raise ValueError(f"{obj.name}: there is no tiling whose poles could be dragged; {AGAIN}")
        self.write_options = tile_run.TileWriteOptions(**dials)
        self._task = targets.tasks([self.target])[0]
        self.tiled = tiling.TiledObject(None, ())
        self.tiled = self.made({})
        vertices, is_pole = tile_report.marks(stored)
        if not np.array_equal(self.poles, vertices[is_pole]):
            raise ValueError(f"{obj.name}: its mesh is not the one that was tiled; {AGAIN}")
        self._map = mesh_io.main_map(obj.data)
        self._uv = mesh_io.read_map(obj.data, self._map)
        self._parts = [part.component.surface.vertex_index for part in self.tiled.done]
        self.allowed = None if self._options.allowed is None else np.frombuffer(self._options.allowed, bool)

    @property
    def poles(self):
        """(n,) vertices of the object, where they are now."""
        return self._marked(lambda made: made.poles)

    @property
    def zeros(self):
        """(n,) vertices of the object."""
        return self._marked(lambda made: made.zeros[0])

    def _marked(self, own):
        return np.concatenate([part.vertices(own(part.tiling)) for part in self.tiled.done])

    def place(self, pole):
        """(number of its part among those with a tiling, its index there)"""
        for number, part in enumerate(self.tiled.done):
            if pole < len(part.tiling.poles):
                return number, pole
            pole -= len(part.tiling.poles)
        raise ValueError(f"there are {len(self.poles)} poles")

    def may_go_to(self, pole, vertex):
        """Whether the vertex is on the pole's part, and where poles are allowed."""
        is_there = vertex in self._parts[self.place(pole)[0]]
        return bool(is_there and (self.allowed is None or self.allowed[vertex]))

    def job(self, moves):
        """A `jobs.Job` that makes the tiling with poles at other vertices, {pole: vertex}; what was dragged in an
        earlier session stays there."""
        options = replace(self._options, moved=self._earlier_and(moves) if moves else self._options.moved)
        return jobs.Job([self._task], then=[partial(tiling.tile, options=options)])

    def _earlier_and(self, moves):
        """((index in its part, vertex), ...): an earlier move of a pole gives way to a new one."""
        new = {self.place(pole): vertex for pole, vertex in moves.items()}
        for index, vertex in self._options.moved:
            (part,) = (number for number, own in enumerate(self._parts) if vertex in own)
            new.setdefault((part, index), vertex)
        return tuple((index, vertex) for (_, index), vertex in new.items())

    def made(self, moves):
        """What the job of these moves gives, here and now."""
        job = self.job(moves)
        job.run()
        return self.taken(job)

    def taken(self, job):
        """The `tiling.TiledObject` of a job that is done. @throws ValueError where the library refused the move"""
        result = job.results[0]
        if isinstance(result, native.refusals()):
            raise ValueError(native.sentence(result))
        for part in result.parts:
            if part.tiling is None and any(part.component is old.component for old in self.tiled.done):
                raise ValueError(native.sentence(part.reason))
        return result

    def show(self, tiled):
        """Writes the map alone."""
        self.tiled = tiled
        uv = tiling.placed(tiled, self.write_options.quarters)
        mesh_io.overwrite_map(self.target.find().data, self.target.polygons, self._map, uv)

    def restore(self):
        """Every bit of the map as it was."""
        mesh_io.overwrite_map(self.target.find().data, None, self._map, self._uv)

    def finish(self, context):
        """Writes all that belongs to a tiling; the `run.Outcome`."""
        return tile_run.write(context, [self.target], [self.tiled], self.write_options, time_has_passed=True)
