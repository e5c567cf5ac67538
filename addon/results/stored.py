# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads stored reports: for panels, and for operators that go on with a tiling."""

import functools
import json
import math
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from ..native import holomorph
from ..scene import mesh_io, stored_dials
from . import shape

SUMMARISED = 8  # parts that a panel shows
MOST_TILES = 10**9  # in a panel
SHOWN_PERIODS = 4  # likewise, of each part


@functools.lru_cache(maxsize=16)
def parsed(stored):
    """Parses a stored report; an empty one if there is none, or if what is stored has not the `shape` of a report."""
    try:
        entry = json.loads(stored)
    except (ValueError, TypeError, RecursionError):
        return {}
    return entry if shape.fits(entry, shape.report()) else {}


def tilings(stored):
    """The tilings of parts, and of pieces of parts."""
    return tilings_of(parsed(stored))


def tilings_of(entry):
    """The tilings of parts, and of pieces of parts, in the report of an object."""
    parts = entry.get("components", [])
    return [tiling for part in parts for tiling in part.get("tilings", [part["tiling"]] if "tiling" in part else [])]


def whole_tilings(stored):
    """The tilings of whole parts, whose points can be dragged."""
    return [part["tiling"] for part in parsed(stored).get("components", []) if "tiling" in part]


def marks(found):
    """The marks of tilings: ((n,) vertices, (n,) whether each is a pole, else a branch point)."""
    poles = [vertex for tiling in found for vertex in tiling["poles"]]
    zeros = [vertex for tiling in found for vertex in tiling["zeros"]]
    return np.array(poles + zeros, np.int64), np.arange(len(poles) + len(zeros)) < len(poles)


def cones(found):
    """(n,) vertices at which tilings that turn have cones, in the place of poles."""
    return np.array([vertex for tiling in found for vertex in tiling.get("cones", [])], np.int64)


def turns(stored):
    """2, 4 or 6 where tilings turn by this part of a full turn; else 1."""
    return max((tiling.get("turns", 1) for tiling in tilings(stored)), default=1)


class Found(NamedTuple):
    """What a panel shows of the tilings of a map, beside the dials that asked for them.

    points : how many there are; movable : of these those of whole parts, which can be dragged; turns : see `turns`
    tiles, width : how many, and how wide they are on the surface; 0 without tilings
    """

    points: int = 0
    movable: int = 0
    turns: int = 1
    tiles: int = 0
    width: float = 0.0


@functools.lru_cache(maxsize=16)
def found(stored):
    """The `Found` of a stored report."""
    parts = [part for part in parsed(stored).get("components", []) if "tiling" in part]
    tiles = min(sum(part["tiling"]["tiles"] for part in parts), MOST_TILES)
    area = max(sum(part["area"] for part in parts), 0.0)
    points, movable = (_point_count(found) for found in (tilings(stored), whole_tilings(stored)))
    return Found(points, movable, turns(stored), round(tiles), math.sqrt(area / tiles) if tiles > 0 else 0.0)


def _point_count(found):
    return sum(len(tiling["poles"]) + len(tiling["cones"]) for tiling in found)


def asked(stored):
    """What a map was asked for, in the fields of a `Request`; None where it is not told."""
    values = parsed(stored).get("asked")
    return values and SimpleNamespace(**{name: shape.as_tuple(value) for name, value in values.items()})


def verdicts(entry):
    """The package's `Verdict`s on an object in a report, to tile and to bake; none where there are none."""
    names = holomorph.quality.verdicts.PURPOSES
    return [holomorph.Verdict(**entry[name]) for name in names] if entry.get("verdict") else []


def whole(entry):
    """The summary of a whole object, before details: whose scale counted, kinds of maps, what was left out, cut and
    joined; "" for one part of which there is nothing to say."""
    scale = [f"in the scale of {entry['scale_of']}"] if "scale_of" in entry else []
    text = "; ".join([*scale, entry["whole"]["text"]]).removesuffix("; ")
    return text[:1].upper() + text[1:]


def joined(entry):
    """How many vertices at one place were joined for the maps, while the mesh has them apart."""
    return entry["repairs"]["joined_vertices"]["count"]


def is_edited(entry, mesh):
    """Whether a mesh was edited since its report was made."""
    return entry.get("shape_key") not in (None, mesh_io.shape_key(mesh))


def is_behind(entry, obj):
    """Whether a map was made of other dials than the object has now."""
    made, now = entry["dials"].get("stored") or {}, stored_dials.of(obj)
    return any(made[name] != value for name, value in now.items() if name in made)


@functools.lru_cache(maxsize=16)
def summary(stored):
    """Short lines for the panel."""
    entry = parsed(stored)
    return list(_summary(entry)) if entry else []


def _summary(entry):
    parts, count = entry["components"], len(entry["maps"])
    yield "1 map" if count == 1 else f"{count} maps"
    yield from cut_lines(entry)
    for index, part in enumerate(parts[:SUMMARISED], 1):
        yield f"Part {index}: {_topology(part)}" + ("" if part["done"] else ", skipped")
        if part["done"]:
            yield from (f"    {line}" for line in _result_lines(part))
    if len(parts) > SUMMARISED:
        yield f"... {holomorph.report.part_count(parts[SUMMARISED:])} more parts in the report"


def cut_lines(entry):
    """What was cut and joined for the maps, by reasons."""
    repairs = entry["repairs"]
    yield from (cut["text"][0].upper() + cut["text"][1:] for cut in repairs["cuts"])
    if joined(entry):
        yield f"{joined(entry):,} vertices at the places of others were joined"


def _topology(part):
    if "genus" not in part:
        return "no surface"
    loops, genus = part["boundary_count"], f"genus {part['genus']}"
    return genus if not loops else f"{genus}, {loops} boundary loop{'s' if loops > 1 else ''}"


def _result_lines(part):
    yield _sentence(part)
    yield from _tiling_lines(part["tiling"]) if "tiling" in part else [part["description"]]
    yield f"angle distortion {part['main_map']['mean_angle']:.4f}"
    if part.get("modulus") is not None:
        yield f"modulus {part['modulus']:.6g}"
        if part.get("modulus_bounds"):
            yield "    between {:.6g} and {:.6g}".format(*part["modulus_bounds"])
    if part["genus"] == 1 and part["boundary_count"] == 0 and part.get("period_matrix"):
        real, imaginary = part["period_matrix"][0][0]
        yield f"tau = {round(real, 4) + 0.0:.4f} + {imaginary:.4f} i"


def _sentence(part):
    """The verdict on the main map of a part, in short."""
    return part["main_map"]["verdict"]["sentence"]


def _tiling_lines(tiling):
    turns = tiling.get("turns", 1)
    if turns != 1:
        yield f"size range {tiling['size_range']:.3g}"
        yield holomorph.quality.verdicts.special(0, turns, len(tiling["cones"]), tiling.get("lines", "none"))
        return
    yield f"angle distortion added by whole tiles: {tiling['added_distortion']:.4f}"
    yield f"size range {tiling['size_range']:.3g}"
    yield f"poles: {len(tiling['poles'])}, branch points: {len(tiling['zeros'])}"
    if tiling["periods"]:
        shown = ", ".join(f"({u}, {v})" for u, v in tiling["periods"][:SHOWN_PERIODS])
        yield f"periods: {shown}" + (", ..." if len(tiling["periods"]) > SHOWN_PERIODS else "")


MOST_TIMES = 200  # beyond, the number does not matter
SIDES = (("the -X side", "the +X side"), ("the front", "the back"), ("the bottom", "the top"))  # of an object


def coarse_places(obj, polygons, density):
    """The `holomorph.coarse_places` of an object as entries of a report, each with a name."""
    found = holomorph.coarse_places(polygons, density)
    return [{"name": _place_name(obj, polygons, place.vertex), **vars(place)} for place in found]


def _place_name(obj, polygons, vertex):
    """The vertex group that is strongest at a vertex; without groups, where the vertex lies on the object."""
    groups = [group for group in obj.data.vertices[vertex].groups if group.weight > 0]
    if groups:
        return obj.vertex_groups[max(groups, key=lambda group: group.weight).group].name
    size = np.maximum(np.ptp(polygons.vertices, axis=0), np.finfo(float).tiny)
    offset = (polygons.vertices[vertex] - polygons.vertices.mean(axis=0)) / size
    axis = int(np.argmax(np.abs(offset)))
    return SIDES[axis][int(offset[axis] > 0)]


def coarse_sentence(found):
    """Such as "the top and 3 more places are 40 times coarser than the rest"; of places in a report."""
    names = list(dict.fromkeys(place["name"] for place in found))
    others = len(found) - 1
    words = names[0] if others == 0 else f"{names[0]} and {others} more place{'s' if others > 1 else ''}"
    if len(found) == 2 and len(names) == 2:
        words = f"{names[0]} and {names[1]}"
    times = max(place["times"] for place in found)
    factor = f"{times:.0f}" if times < MOST_TIMES else f"over {MOST_TIMES}"
    text = f"{words} {'is' if others == 0 else 'are'} {factor} times coarser than the rest"
    return text[0].upper() + text[1:]
