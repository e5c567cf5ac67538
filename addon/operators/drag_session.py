# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiling while its poles are dragged: what there was, what comes of a move, and its end. No events in here."""

from dataclasses import replace
from functools import partial
from itertools import chain

import numpy as np

from .. import native
from ..maps import mapped
from ..results import report, write
from ..scene import stored_dials, targets, uv_maps
from ..solving import jobs
from ..writing import transaction
from . import request

AGAIN = "press Update Map"


class Session:
    """A tiling whose poles are dragged. Poles are counted as in the report: part by part."""

    def __init__(self, obj):
        """Takes up the tiling of an object. @throws ValueError where there is none, or no longer"""
        known = stored_dials.made(obj)
        if known and known.is_selection:
            raise ValueError(
                f"{obj.name}: points can be dragged only where the whole mesh was tiled, not selected faces"
            )
        if known and known.scale_of:
            other = f"{known.scale_of}: its mesh was tiled in the scale of that object"
            raise ValueError(f"{obj.name}: drag the points on {other}")
        dials = getattr(obj, stored_dials.NAME)
        self.target, self._map = request.collect([obj], dials)[0], uv_maps.main_map(obj.data)
        if not known or self.target.refused or self._map not in obj.data.uv_layers:
            raise ValueError(f"{obj.name}: it has no map with points to drag; {AGAIN}")
        if stored_dials.is_behind(obj):
            raise ValueError(f"{obj.name}: its dials were changed since its map was made; {AGAIN}")
        own, _ = request.own_texture(dials)
        self._wanted, self._write_options = request.Run(dials, [self.target], own, goes_on=True).only
        vertices, kinds = report.points(obj, whole=True)
        self.are_cones, self._earlier = report.CONE in kinds, request.moved_points(dials, self.target)
        self._count = stored_dials.asked_count(dials)
        self._task = targets.tasks([self.target])[0]
        self.mapped = None
        self.mapped = self._first = self._wanted = self.made({})
        if not self._tiled(self.mapped):
            reasons = [part.skipped or part.not_seamless for part in self.mapped.parts]
            raise ValueError(f"{obj.name}: {'; '.join(filter(None, reasons))}")
        if not np.array_equal(self.poles, vertices[kinds == (report.CONE if self.are_cones else report.POLE)]):
            raise ValueError(f"{obj.name}: its mesh has changed since it was tiled; {AGAIN}")
        self._uv, self._is_shown = uv_maps.read_map(obj.data, self._map), False
        self._parts = [part.component.surface.vertex_index for part in self._tiled(self.mapped)]
        self._boundary = np.concatenate([self._boundary_of(part) for part in self._tiled(self.mapped)])
        self.allowed = self._wanted.request.allowed

    @property
    def poles(self):
        """(n,) vertices of the object, where they are now; or the cones of a map that turns."""
        if self.are_cones and self.mapped is not self._first:
            return np.array([*self.mapped.request.cones])
        return np.concatenate([part.vertices(own) for part, own in zip(self._tiled(self.mapped), self._own)])

    @staticmethod
    def _tiled(made):
        """The parts of a `mapped.MappedObject` with a tiling of the whole of them."""
        return [part for part in made.tiled if part.tiling]

    @property
    def _own(self):
        """The poles of each part with a tiling, or the cones, as the part counts vertices."""
        name = "cones" if self.are_cones else "poles"
        return [getattr(part.tiling, name) for part in self._tiled(self._first)]

    @property
    def zeros(self):
        """(n,) vertices of the object at the branch points."""
        return np.concatenate([part.vertices(part.tiling.zeros[0]) for part in self._tiled(self.mapped)])

    @staticmethod
    def _boundary_of(part):
        """Vertices of the object on its boundary."""
        return part.vertices(native.module("mesh.edges").boundary_edges(part.map.surface).ravel())

    def place(self, pole):
        """(number of its part among those with a tiling, its index there)"""
        index = pole
        for number, own in enumerate(self._own):
            if index < len(own):
                return number, index
            index -= len(own)
        raise ValueError(f"point {pole} does not exist: there are {len(self.poles)}")

    def may_go_to(self, pole, vertex):
        """Whether the vertex is on the pole's part, and where poles are allowed; that of a cone is inside, and has no
        other one."""
        is_there = vertex in self._parts[self.place(pole)[0]]
        if self.are_cones and (vertex in self._boundary or vertex in np.delete(self.poles, pole)):
            return False
        return bool(is_there and (self.allowed is None or self.allowed[vertex]))

    def job(self, moves):
        """A `jobs.Job` that makes the tiling with poles at other vertices, {pole: vertex}; what was dragged in an
        earlier session stays there."""
        wanted = self._moved(moves) if moves else self._wanted
        return jobs.Job([self._task], then=partial(mapped.follow, [wanted], False))

    def _moved(self, moves):
        """The `mapped.MappedObject` that is wanted with these moves."""
        request = self._wanted.request
        if not self.are_cones:
            return replace(self._wanted, request=replace(request, moves=self._earlier_and(moves)), points=())
        places = np.concatenate([part.vertices(own) for part, own in zip(self._tiled(self._first), self._own)])
        places[list(moves)] = list(moves.values())
        angles = np.concatenate([part.tiling.cone_angles for part in self._tiled(self._first)])
        cones = dict(zip(places.tolist(), angles.tolist()))
        return replace(self._wanted, request=replace(request, cones=cones, lines="automatic", marked=None))

    def _earlier_and(self, moves):
        """((index in its part, vertex), ...): an earlier move of a pole gives way to a new one."""
        new = {self.place(pole): vertex for pole, vertex in moves.items()}
        for index, vertex in self._wanted.request.moves:
            (part,) = (number for number, own in enumerate(self._parts) if vertex in own)
            new.setdefault((part, index), vertex)
        return tuple((index, vertex) for (_, index), vertex in new.items())

    def made(self, moves):
        """Makes the tiling of these moves at once. @throws ValueError for a vertex where the pole cannot go"""
        for pole, vertex in moves.items():
            if not self.may_go_to(pole, vertex):
                why = "on another part or not allowed" if not self.are_cones else "no place of its own inside its part"
                raise ValueError(f"point {pole} cannot move to vertex {vertex}, which is {why}")
        if self.are_cones and len(set(moves.values())) < len(moves):
            raise ValueError("two points cannot move to one vertex")
        job = self.job(moves)
        job.run()
        return self.taken(job)

    def taken(self, job):
        """The `mapped.MappedObject` of a job that is done. @throws ValueError where the library refused the move"""
        result = job.error or job.results[0]
        if isinstance(result, jobs.REFUSALS):
            raise ValueError(native.sentence(result))
        before = [part.component for part in self._tiled(self.mapped)] if self.mapped else []
        for part in result.parts:
            reason = part.skipped or part.not_seamless
            if reason and any(part.component is component for component in before):
                raise ValueError(reason)
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
        """Writes all that belongs to a tiling, and returns the `write.Outcome`."""
        self.restore()  # the step puts back what it finds
        options = self._write_options
        if self.mapped is not self._first:
            options = replace(options, stored=options.stored | {stored_dials.MOVED: self._points.text})
        with transaction.one_step(context, targets.objects([self.target])) as step:
            return write.write(step, [self.target], [self.mapped], options, time_has_passed=True)

    @property
    def _points(self):
        """The `stored_dials.Points` of the map as it is now; those on maps with other turns stay."""
        asked = self.mapped.request
        earlier = self._earlier or stored_dials.Points(len(self.target.find().data.vertices), self._count)
        if self.are_cones:
            return replace(earlier, cones=tuple((asked.cones or {}).items()))
        base = asked.poles if isinstance(asked.poles, tuple) else ()
        moved = {*base, *(vertex for _, vertex in asked.moves)}
        now = [part.vertices(part.tiling.poles).tolist() for part in self._tiled(self.mapped)]
        poles = [own for own, part in zip(now, self._parts) if not moved.isdisjoint(part.tolist())]
        return replace(earlier, poles=tuple(chain(*poles)), base=base, moves=asked.moves)
