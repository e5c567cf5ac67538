# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiling while its poles are dragged: what there was, what comes of a move, and its end. No events in here."""

from dataclasses import replace

import numpy as np

from .. import native
from ..maps import mapped
from ..maps.mapped import TILING, MapOptions
from ..results import report, stored, write
from ..scene import targets, uv_maps
from ..solving import jobs
from ..writing import transaction
from . import request

AGAIN = "run Seamless Tiling again"


class Session:
    """A tiling whose poles are dragged. Poles are counted as in the report: part by part."""

    def __init__(self, obj):
        """Takes up the tiling that the report tells of. @throws ValueError where there is none, or no longer"""
        text = obj.get(report.PROPERTY)
        if stored.parsed(text).get("is_selection"):
            raise ValueError(
                f"{obj.name}: poles can be dragged only where the whole mesh was tiled, not selected faces"
            )
        other = stored.parsed(text).get("scale_of")
        if other:
            raise ValueError(f"{obj.name}: drag the poles on {other}: its mesh was tiled in the scale of that object")
        self.target, asked = targets.collect([obj])[0], stored.asked(text)
        self._map = uv_maps.main_map(obj.data)
        if asked is None or self.target.refused or self._map not in obj.data.uv_layers:
            raise ValueError(f"{obj.name}: it has no tiling with poles to drag; {AGAIN}")
        self._asked = replace(asked, allowed=request.allowed(asked.pole_group, obj))
        self._write_options = write.options_of(stored.parsed(text)["dials"])
        self._task = targets.tasks([self.target])[0]
        self.mapped = None
        self.mapped = self.made({})
        vertices, is_pole = stored.marks(text)
        if not np.array_equal(self.poles, vertices[is_pole]):
            raise ValueError(f"{obj.name}: its mesh has changed since it was tiled; {AGAIN}")
        self._uv, self._is_shown = uv_maps.read_map(obj.data, self._map), False
        self._parts = [part.component.surface.vertex_index for part in self.mapped.tiled]
        self.allowed = None if self._asked.allowed is None else np.frombuffer(self._asked.allowed, bool)

    @property
    def poles(self):
        """(n,) vertices of the object, where they are now."""
        return np.concatenate([part.vertices(part.tiling.poles) for part in self.mapped.tiled])

    @property
    def zeros(self):
        """(n,) vertices of the object at the branch points."""
        return np.concatenate([part.vertices(part.tiling.zeros[0]) for part in self.mapped.tiled])

    def place(self, pole):
        """(number of its part among those with a tiling, its index there)"""
        for number, part in enumerate(self.mapped.tiled):
            if pole < len(part.tiling.poles):
                return number, pole
            pole -= len(part.tiling.poles)
        raise ValueError(f"pole {pole} does not exist: there are {len(self.poles)}")

    def may_go_to(self, pole, vertex):
        """Whether the vertex is on the pole's part, and where poles are allowed."""
        is_there = vertex in self._parts[self.place(pole)[0]]
        return bool(is_there and (self.allowed is None or self.allowed[vertex]))

    def job(self, moves):
        """A `jobs.Job` that makes the tiling with poles at other vertices, {pole: vertex}; what was dragged in an
        earlier session stays there."""
        asked = replace(self._asked, moved=self._earlier_and(moves) if moves else self._asked.moved)
        options = MapOptions(forms=0, main=TILING, tiling=asked)
        return jobs.Job([self._task], then=mapped.follow([options]))

    def _earlier_and(self, moves):
        """((index in its part, vertex), ...): an earlier move of a pole gives way to a new one."""
        new = {self.place(pole): vertex for pole, vertex in moves.items()}
        for index, vertex in self._asked.moved:
            (part,) = (number for number, own in enumerate(self._parts) if vertex in own)
            new.setdefault((part, index), vertex)
        return tuple((index, vertex) for (_, index), vertex in new.items())

    def made(self, moves):
        """Makes the tiling of these moves at once. @throws ValueError for a vertex where the pole cannot go"""
        for pole, vertex in moves.items():
            if not self.may_go_to(pole, vertex):
                raise ValueError(f"pole {pole} cannot move to vertex {vertex}, which is on another part or not allowed")
        job = self.job(moves)
        job.run()
        return self.taken(job)

    def taken(self, job):
        """The `mapped.MappedObject` of a job that is done. @throws ValueError where the library refused the move"""
        result = job.error or job.results[0]
        if isinstance(result, native.refusals()):
            raise ValueError(native.sentence(result))
        before = [part.component for part in self.mapped.tiled] if self.mapped else []
        for part in result.parts:
            if part.skipped and any(part.component is component for component in before):
                raise ValueError(part.skipped)
        return result

    def show(self, made):
        """Writes the map alone."""
        self.mapped, self._is_shown = made, True
        _, uv = next(made.maps())
        uv_maps.overwrite_map(self.target.find().data, self.target.polygons, self._map, uv)

    def restore(self):
        """Takes back what is shown, to the last bit of the map."""
        if self._is_shown:
            uv_maps.overwrite_map(self.target.find().data, None, self._map, self._uv)
            self._is_shown = False

    def finish(self, context):
        """Writes all that belongs to a tiling, and returns the `report.Outcome`."""
        self.restore()  # the step puts back what it finds
        with transaction.one_step(context, targets.objects([self.target])) as step:
            return write.write(step, [self.target], [self.mapped], self._write_options, time_has_passed=True)
