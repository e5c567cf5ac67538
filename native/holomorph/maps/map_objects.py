"""The maps of all parts of several objects, with squares of one size."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..core.array_types import Progress
from ..core.progress import scaled, side_by_side
from ..mesh.copies import Copy, copies
from .map import Map
from .map_search import MapSearch
from .request import Request
from .size import TRIES, SizePolicy, best_window, relative_size, window_around
from .tiling_search import REFUSALS, Refusal

LEADING = 0.25  # part of the area of the largest part, from which on a part may say the density of all
SOLVING = 0.5  # part of the work, for what needs no size
TRYING = 0.9  # part of the work on tilings, for numbers of tiles
SCALE_DIGITS = 3  # to which the logarithm of a copy's scale is rounded: parts that differ by less have the same tiles

Made: TypeAlias = Map | Refusal | MemoryError


class MappedParts(NamedTuple):
    """maps : of the parts of one object; size : with which that object alone gets the same maps"""

    maps: list[Made]
    size: SizePolicy


class _Sized(NamedTuple):
    """made : {part: its map, or how it is refused}; leader : the part whose density is that of the others, if any;
    size : of the others"""

    made: dict[int, Made]
    leader: int | None
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
    requests = [request for parts in objects for request in parts]
    made, leader, others = _map_parts(requests, _alike(objects, progress), size, threads, progress)
    result, first = [], 0
    for parts in objects:
        last = first + len(parts)
        leads = leader is not None and first <= leader < last
        result.append(MappedParts(made[first:last], replace(size, window=others.window) if leads else others))
        first = last
    return result


def _map_parts(requests, alike, size, threads, progress):
    """([map or error of each part], `_Sized.leader`, `_Sized.size`)"""
    done = SOLVING if any(request.structure is None for request in requests) else 0.0
    searches = _searches(requests, alike, threads, scaled(progress, 0.0, done))
    sized, leader, others = _sized(requests, alike, searches, size, threads, scaled(progress, done, 1.0))
    found = [sized[k] if k in sized else _final(searches[copy.first]) for k, copy in enumerate(alike)]
    maps = [
        one if alike[k].first == k or not isinstance(one, Map) else _of_copy(one, requests[k], alike[k].scale)
        for k, one in enumerate(found)
    ]
    return maps, leader, others


def _final(search):
    """The map of a part whatever the size of squares, or how it is refused; None where that depends on it."""
    return search.final if isinstance(search, MapSearch) else search


def _of_copy(found, request, scale):
    """The map of a copy of its part."""
    return found.of_copy(request.surface, request.structure, scale)


def _alike(objects, progress):
    """The `Copy` that each part is, of one of its own object, or of exactly the same in another: so an object alone has
    the maps that it has beside others. Parts of which something else is asked are not copies. Nor are those that are
    turned about the vertical if u is to run along a vector."""
    result, same = [], {}
    for requests in objects:
        surfaces, keys, first = [one.surface for one in requests], [one.key for one in requests], len(result)
        is_level = all(isinstance(one.direction, (str, type(None))) for one in requests)
        found = copies(surfaces, progress) if is_level else map(Copy, range(len(requests)))
        for k, copy in enumerate(found):
            if copy.first != k and keys[copy.first] == keys[k]:
                known = result[first + copy.first]
                result.append(Copy(known.first, copy.scale * known.scale))
            else:
                result.append(Copy(same.setdefault((keys[k], _digest(surfaces[k])), len(result))))
    return result


def _digest(surface):
    """Equal for surfaces that are the same to the last bit; none is the same as an intrinsic one."""
    if surface.vertices is None:
        return id(surface)
    digest = hashlib.sha256()
    for each in (surface.vertices, surface.corner_vertices, surface.face_offsets):
        digest.update(np.ascontiguousarray(each))
    return digest.digest()


def _or_error(work: Callable[..., Any]) -> Callable[..., Any]:
    """The same function, but that what refuses one part is its result: others go on."""

    def guarded(*arguments):
        try:
            return work(*arguments)
        except (*REFUSALS, MemoryError) as error:
            return error.with_traceback(None)  # which holds what took the memory

    return guarded


def _searches(requests, alike, threads, progress):
    """{part: its `MapSearch`, or the error of that}, without copies."""
    firsts = [k for k, copy in enumerate(alike) if copy.first == k]
    work = _or_error(lambda i, count, step: MapSearch(requests[firsts[i]], count, step))
    found = side_by_side(work, [len(requests[k].surface.triangles) for k in firsts], threads, progress)
    return dict(zip(firsts, found))


def _sized(requests, alike, searches, size, threads, progress):
    """The `_Sized` of parts whose map depends on the size of squares. The maps of copies are those of the first
    part."""
    members = [k for k, copy in enumerate(alike) if _final(searches[copy.first]) is None]
    if not members:
        return _Sized({}, None, size)
    names = {k: (alike[k].first, round(math.log(alike[k].scale), SCALE_DIGITS)) for k in members}
    areas, density, share, leader, made = _areas(requests, names), size.density, 0.0, None, {}
    for k in _leaders(requests, names) if size.tolerance != 0 else ():
        wanted, about = _on_first(density, alike[k]), _or_error(searches[alike[k].first].about)
        part = 0.5 * requests[k].surface.area / (sum(areas.values()) or 1.0)  # the rest is for other maps of the part
        found = about(wanted, size.tries, scaled(progress, share, share + part))
        share += part
        leads = isinstance(found, Map) and found.is_tiled and size.takes(relative_size(found, wanted))
        if leads and (leader is None or found.tiling):
            leader, made = k, {names[k]: found}
        elif size.tolerance is None and leader is None:
            made[names[k]] = found
        if leads and found.tiling:
            break  # pieces may have any density, a tiling of the whole part may not
    if leader is not None:
        density = made[names[leader]].density / alike[leader].scale ** 2
    wanted = {names[k]: _on_first(density, alike[k]) for k in reversed(members) if names[k] not in made}
    window = size.window or (window_around() if leader is None else None)
    asked = replace(size, window=window)
    more, window = _of_one_size(requests, searches, wanted, areas, asked, threads, scaled(progress, share, 1.0))
    others = SizePolicy(density, tolerance=0.0, window=window, near=size.near)
    made |= more
    return _Sized({k: made[names[k]] for k in members}, leader, others)


def _areas(requests, names):
    """{name: total area of the parts with that name}."""
    areas = dict.fromkeys(names.values(), 0.0)
    for k, name in names.items():
        areas[name] += requests[k].surface.area
    return areas


def _leaders(requests, names):
    """The parts that may say the density of all, the largest first: the first one with a tiling does, or with pieces
    that are tilings."""
    areas = {k: requests[k].surface.area for k in {name: k for k, name in reversed(names.items())}.values()}
    return sorted((k for k in areas if areas[k] >= LEADING * max(areas.values())), key=lambda k: (-areas[k], k))


def _of_one_size(requests, searches, wanted, areas, size, threads, progress):
    """({(part, scale): its map or how it is refused}, the window) for densities by these. One of each part is tried
    before the others: it places the poles for all."""
    leading = list({name[0]: name for name in wanted}.values())
    following = [name for name in wanted if name not in set(leading)]

    def done(names, work, start, end):
        sizes, guarded = [len(requests[name[0]].surface.triangles) for name in names], _or_error(work)
        made = side_by_side(
            lambda i, _threads, step: guarded(names[i], step), sizes, threads, scaled(progress, start, end)
        )
        return dict(zip(names, made))

    def tried(name, step):
        return searches[name[0]].maps(wanted[name], TRIES, False, step)

    found = done(leading, tried, 0.0, TRYING / 2) | done(following, tried, TRYING / 2, TRYING)
    sizes = {
        name: [relative_size(made, wanted[name]) for made in each]
        for name, each in found.items()
        if not isinstance(each, Exception)
    }
    window = size.window or best_window(list(sizes.values()), [areas[name] for name in sizes])

    def fitted(name, step):
        return searches[name[0]].fitted(found[name], wanted[name], window, size.near, step)

    return done(list(found), fitted, TRYING, 1.0), window


def _on_first(density, copy):
    """The density of a copy's map on the first part."""
    return density * copy.scale**2
