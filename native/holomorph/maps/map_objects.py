"""The maps of all parts of several objects, with squares of one size. The core chooses: native/src/choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from .. import _native
from .._native import InvalidMesh, SolverError, TopologyError
from ..core.array_types import Progress
from ..mesh.checks import check_threads
from .automatic_structure import AnyStructure, structure_of
from .late_structure import LateStructure
from .map import Map
from .request import Request
from .size import SizePolicy

REFUSALS = InvalidMesh, TopologyError, SolverError  # what is said about one part, others go on
Refusal: TypeAlias = InvalidMesh | TopologyError | SolverError
Made: TypeAlias = Map | Refusal | MemoryError


class MappedParts(NamedTuple):
    """maps : of the parts of one object; size : with which that object alone gets the same maps"""

    maps: list[Made]
    size: SizePolicy


def map_objects(
    objects: Sequence[Sequence[Request]], size: SizePolicy, threads: int | None = None, progress: Progress | None = None
) -> list[MappedParts]:
    """The maps of the parts of each object, with squares of one size over all of them.

    The median densities of tilings differ by a tenth at most from that of the largest part, which is made first, or by
    up to a fifth where other maps cost more. A part on which whole tiles are too few for that, or have no room, gets
    another map, which `arrangement` scales. Small parts are made side by side, and copies of one part once. What has
    no map, also for want of memory, gets the error.
    """
    threads = check_threads(threads)
    asked = [[_or_error(request.of_core) for request in parts] for parts in objects]
    fitting = [[one for one in parts if not isinstance(one, Exception)] for parts in asked]
    found = _native.map_objects(fitting, size.core, threads=threads, progress=progress)
    requests = [r for parts, cores in zip(objects, asked) for r, core in zip(parts, cores) if _is_core(core)]
    maps, result = _Maps(requests, threads), []
    for cores, (mapped, own_size) in zip(asked, found):
        made = iter(mapped)
        own = [maps.of(next(made)) if _is_core(core) else core for core in cores]
        result.append(MappedParts(own, SizePolicy.of_core(own_size)))
    return result


def _is_core(asked):
    return not isinstance(asked, Exception)


def _or_error(work):
    """What a function returns, or what refuses one part: others go on."""
    try:
        return work()
    except (*REFUSALS, MemoryError) as error:
        return error.with_traceback(None)  # which holds what took the memory


class _Maps:
    """The maps of the core as those of Python. A map that copies share is converted once."""

    def __init__(self, requests, threads):
        self._requests, self._threads = requests, threads
        self._structures: dict[int, AnyStructure | LateStructure] = {}
        self._maps: dict[_native.Map, Map] = {}
        self._next = 0

    def of(self, made):
        """The map of the next part."""
        request, is_first = self._requests[self._next], made.first == self._next
        self._next += 1
        if made.map is None:
            return _or_error(made.raise_refusal)
        if made.map not in self._maps:
            self._maps[made.map] = self._converted(made.map, made.first)
        found = self._maps[made.map]
        return found if is_first else found.of_copy(request.surface, request.structure, made.scale)

    def _converted(self, made, part):
        surface = self._requests[part].surface
        if part not in self._structures:
            self._structures[part] = self._structure(made.structure, self._requests[part])
        return Map.of_core(made, surface, self._structures[part])

    def _structure(self, core, request):
        if core is None:  # islands took its place
            return request.structure or LateStructure(request.surface, request.surface, self._threads)
        given = request.structure
        if isinstance(given, LateStructure) and "made" in vars(given):
            given = given.made
        is_given = given is not None and not isinstance(given, LateStructure)
        return given if is_given else structure_of(core, request.surface, self._threads)
