"""The maps of all parts of several objects, with squares of one size. The core chooses: native/src/choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from .. import _native
from .._native import InvalidMesh, SolverError, TopologyError
from ..core.array_types import Progress
from ..mesh.checks import check_threads
from ..mesh.surface import Surface
from ..tiling.request import Request, Size, plain_size
from .automatic_structure import AnyStructure, structure_of
from .late_structure import LateStructure
from .map import Map

REFUSALS = InvalidMesh, TopologyError, SolverError  # what is said about one part, others go on
Refusal: TypeAlias = InvalidMesh | TopologyError | SolverError
Made: TypeAlias = Map | Refusal | MemoryError
Asked: TypeAlias = tuple[Request, Surface, AnyStructure | LateStructure | None]  # of a part, in its own vertices


class MappedParts(NamedTuple):
    """maps : of the parts of one object; size : with which that object alone gets the same maps"""

    maps: list[Made]
    size: Size


def map_objects(
    objects: Sequence[Sequence[Asked]],
    size: Size,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[MappedParts]:
    """The maps of the parts of each object, with squares of one size over all of them.

    The median densities of tilings differ by a tenth at most from that of the largest part, which is made first, or by
    up to a fifth where other maps cost more. A part on which whole tiles are too few for that, or have no room, gets
    another map, which `arrangement` scales. Small parts are made side by side, and copies of one part once. What has
    no map, also for want of memory, gets the error.
    """
    threads, kind = check_threads(threads), _native.Request
    asked = [[_or_error(_core, *each) for each in parts] for parts in objects]
    fitting = [[core for core in cores if isinstance(core, kind)] for cores in asked]
    found = _native.map_objects(fitting, _native.SizePolicy(*size), threads=threads, progress=progress)
    pairs = (pair for each in zip(objects, asked) for pair in zip(*each))
    maps, result = _Maps([part for part, core in pairs if isinstance(core, kind)], threads), []
    for cores, (mapped, own_size) in zip(asked, found):
        made = iter(mapped)
        own = [maps.of(next(made)) if isinstance(core, kind) else core for core in cores]
        result.append(MappedParts(own, plain_size(own_size)))
    return result


def _core(request, surface, structure):
    """The core's request. Where a structure is not solved for yet, other maps than of forms may do."""
    if isinstance(structure, LateStructure):
        is_needed = request.main in ("seamless", "balanced") or not isinstance(request.poles, str)
        structure = structure.made if is_needed else None
    return request.core(surface, structure)


def _or_error(work, *arguments):
    """What a function returns, or what refuses one part: others go on."""
    try:
        return work(*arguments)
    except (*REFUSALS, MemoryError) as error:
        return error.with_traceback(None)  # which holds what took the memory


class _Maps:
    """The maps of the core as those of Python. A map that copies share is converted once."""

    def __init__(self, parts, threads):
        self._parts, self._threads, self._next = parts, threads, 0
        self._structures: dict[int, AnyStructure | LateStructure] = {}
        self._maps: dict[_native.Map, Map] = {}

    def of(self, made):
        """The map of the next part."""
        (_, surface, structure), is_first = self._parts[self._next], made.first == self._next
        self._next += 1
        if made.map is None:
            return _or_error(made.raise_refusal)
        if made.map not in self._maps:
            self._maps[made.map] = self._converted(made.map, made.first)
        found = self._maps[made.map]
        return found if is_first else found.of_copy(surface, structure, made.scale)

    def _converted(self, made, part):
        _, surface, structure = self._parts[part]
        if part not in self._structures:
            self._structures[part] = self._structure(made.structure, surface, structure)
        return Map.of_core(made, surface, self._structures[part])

    def _structure(self, core, surface, given):
        if core is None:  # islands took its place
            return given or LateStructure(surface, surface, self._threads)
        if isinstance(given, LateStructure):
            given = vars(given).get("made")
        return structure_of(core, surface, self._threads) if given is None else given
