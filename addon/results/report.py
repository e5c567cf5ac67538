# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a run, as JSON in a custom property of each object and in a text datablock, which is not read; and what
an object stores of it beside its dials, and the reading of that."""

import json
import math
import re
from dataclasses import asdict, replace

import bpy
import numpy as np

from ..native import holomorph
from ..scene import gathering, mesh_io, stored_dials, uv_maps

PROPERTY = "holomorph_report"
PROPERTY_LIMIT = 1_000_000  # characters; reached at a genus of about 120
MOST_OTHERS = 100  # objects with one mesh that get its report, besides the one that was mapped
MATRICES = ("period_matrix", "period_bounds", "capacity_matrix", "capacity_bounds")
TEXT = "Holomorphic Report"


def object_report(obj, made, written=(), new_seams=0, write_options=None):
    """One object: its maps as written, the options with which they were, and the report of each part."""
    solved = made.solved
    given = [(one.component.surface, one.map, one.skipped, one.component.note) for one in made.parts]
    about = holomorph.report.parts_report(given, solved.surface.refused, _repairs(solved), made.arrangement)
    dials, asked = {"forms": made.forms, "main": made.main, **asdict(made.arrangement)}, asdict(made.request)
    # A vertex group and the marks of the object say the others.
    asked = {name: value for name, value in asked.items() if name not in ("allowed", "marked", "seams")}
    return {
        "object": obj.name,
        "mesh": obj.data.name,
        "shape_key": mesh_io.shape_key(obj.data),
        "vertices": len(solved.polygons.vertices),
        "faces": solved.polygons.face_count,
        "is_selection": solved.polygons.faces is not None,
        "done": bool(made.done),
        "maps": [{"name": w.name, "stored_as": w.kind} for w in written],
        "dials": dials | (asdict(write_options) if write_options else {}),
        "asked": holomorph.core.value.plain(asked),
        "seams_added": new_seams,
        **about,
        "seconds": solved.seconds,
    }


def _repairs(solved):
    """The repairs of a `solve.SolvedObject`, with faces as the mesh counts them; vertices of other faces are not
    isolated."""
    found, faces = solved.surface.repairs, solved.polygons.faces
    if faces is None:
        return found
    none = np.empty(0, np.int64)
    of_mesh = {name: faces[getattr(found, name)] for name in ("reversed_faces", "zero_area_faces")}
    cuts = tuple(replace(cut, faces=faces[cut.faces]) for cut in found.cuts)
    return replace(found, isolated_vertices=none, cuts=cuts, **of_mesh)


def refusal_report(name, sentence):
    """One object that was left untouched, and why."""
    return {"object": name, "done": False, "refused": sentence}


def as_json(value, indent=None):
    """Standard JSON of a report."""
    return json.dumps(value, indent=indent, allow_nan=False)


def store(obj, entry):
    """Stores the report on an object that was mapped, and what is known of its map; and on others with its mesh, whose
    scale may be another; on so many of these that a file stays small."""
    _store_on_object(obj, entry)
    others = gathering.others(obj)
    for other in others[:MOST_OTHERS]:
        scale = {"scale_of": obj.name} if gathering.has_other_scale(obj, other) else {}
        _store_on_object(other, {**entry, "object": other.name, **scale})
    for other in others[MOST_OTHERS:]:
        remove(other)  # it told of an earlier map


def remove(obj):
    """Takes the report away, and what is known of the map; returns whether there was something."""
    is_known = stored_dials.made(obj) is not None
    stored_dials.know(obj)
    return obj.pop(PROPERTY, None) is not None or is_known


def _store_on_object(obj, entry):
    """Stores the entry without matrices that would make the property long: they are in the text as well."""
    text = as_json(entry)
    if len(text) > PROPERTY_LIMIT:
        parts = [{k: v for k, v in part.items() if k not in MATRICES} for part in entry["components"]]
        text = as_json({**entry, "components": parts})
    obj[PROPERTY] = text
    stored_dials.know(obj, values(entry), entry["dials"]["stored"])


def store_text(entries):
    """Replaces the text datablock with the report of all objects of one run."""
    text = bpy.data.texts.get((TEXT, None)) or bpy.data.texts.new(TEXT)
    text.from_string(as_json(run_report(entries), indent=1))


def run_report(entries):
    return {
        "holomorph": getattr(holomorph, "__version__", ""),
        "blender": bpy.app.version_string,
        "objects": entries,
    }


def with_coarse_places(obj, polygons, entry):
    """The report's entry with the places that the main map leaves coarse, where it is uneven, and how many faces are
    too small in it for the single precision of Blender's UV maps."""
    ratios = [part["main_map"]["size_range"] for part in entry["components"] if part["done"]]
    if None not in ratios and max(ratios) <= holomorph.UNEVEN[-1]:
        return entry | {"coarse_places": [], "faces_without_area": 0}
    distortion = holomorph.distortion
    found = distortion.measure(polygons, uv_maps.read_corners(obj.data, polygons, entry["maps"][0]["name"]))
    places = coarse_places(obj, polygons, found.density)
    without_area = int(np.count_nonzero(found.angle >= distortion.COLLAPSED))
    return entry | {"coarse_places": places, "faces_without_area": without_area}


SUMMARISED = 8  # parts that a panel shows
MOST_TILES = 10**9  # in a panel
SHOWN_PERIODS = 4  # likewise, of each part
POLE, ZERO, CONE = range(3)  # kinds of points: zeros are branch points
POINTS = {"poles": POLE, "zeros": ZERO, "cones": CONE}
OF_PIECES = len(POINTS)  # added to the kind of points that cannot be dragged: of tilings of pieces of parts
UNSAID = re.compile(r"\b(poles?|cones?|turns)\b")  # what the row of the points and that of the turns show
TILES_OVERLAP = "Tiles lie on top of each other"


def values(entry):
    """{name: value} of what an object stores, see `operators.dials`, out of the report on its maps."""
    tilings, dials, asked = tilings_of(entry), entry["dials"], entry["asked"]
    parts = [part for part in entry["components"] if "tiling" in part]
    tiles, area = sum(part["tiling"]["tiles"] for part in parts), sum(part["area"] for part in parts)
    points = list(_points(entry))
    dots = [kind for _, kind in points if kind % OF_PIECES != ZERO]
    tile, bake = [holomorph.Verdict(**entry[name]) for name in holomorph.quality.verdicts.PURPOSES]
    own, places = dials["own"] or {}, entry["coarse_places"]
    return {
        "map": entry["maps"][0]["name"],
        "shape_key": str(entry["shape_key"]),
        "scale_of": entry.get("scale_of", ""),
        "is_selection": entry["is_selection"],
        "size": repr(asked["size"]),
        "lattice": repr(asked["lattice"]),
        "together": dials["together"],
        "own_turns": own.get("turns", 0),
        "averaged": own.get("averaged", 1),
        "is_tiled": bool(tilings),
        "turns": max((tiling["turns"] for tiling in tilings), default=1),
        "tiles": round(min(tiles, MOST_TILES)),
        "width": math.sqrt(area / tiles) if tiles > 0 else 0.0,
        "points": " ".join(f"{vertex} {kind}" for vertex, kind in points),
        "point_count": len(dots),
        "movable_count": sum(kind < OF_PIECES for kind in dots),
        "coarse": coarse_sentence(places) if places else "",
        "coarse_vertices": " ".join(str(place["vertex"]) for place in places),
        "cost": cost(entry),
        "is_fit": tile.is_fit,
        "is_bake_fit": bake.is_fit and not tilings,
        "sentence": ", ".join(words for words in tile.sentence.split(", ") if not UNSAID.search(words)),
        "whole": whole(entry),
        "bake_sentence": TILES_OVERLAP if tilings else bake.sentence,
        "numbers": "\n".join(map("\t".join, numbers(entry))),
        "summary": "\n".join(_summary(entry)),
    }


def tilings_of(entry):
    """The tilings of parts, and of pieces of parts, in the report of an object."""
    return [tiling for part in entry["components"] for tiling, _ in _tilings(part)]


def _tilings(part):
    """(a tiling, what is added to the kind of its points) in the report of a part."""
    pieces = [(tiling, OF_PIECES) for tiling in part.get("tilings", [])]
    return pieces or ([(part["tiling"], 0)] if "tiling" in part else [])


def _points(entry):
    """(vertex, kind) of the points of tilings, those of each kind together, in the order of the parts."""
    tilings = [each for part in entry["components"] for each in _tilings(part)]
    for name, kind in POINTS.items():
        for tiling, more in tilings:
            yield from ((vertex, kind + more) for vertex in tiling[name])


def points(obj, whole=False):
    """((n,) vertices, (n,) kinds) of the points of tilings; whole : of those of whole parts, which can be dragged"""
    made = stored_dials.made(obj)
    vertices, kinds = np.array(made.points.split() if made else [], np.int64).reshape(-1, 2).T
    is_taken = kinds < OF_PIECES if whole else kinds >= 0
    return vertices[is_taken], kinds[is_taken] % OF_PIECES


def is_edited(obj):
    """Whether the mesh of an object was edited since its map was made."""
    made = stored_dials.made(obj)
    return made is not None and made.shape_key != str(mesh_io.shape_key(obj.data))


def cost(entry):
    """That of the maps of an object to an eye, of its report."""
    found = entry["whole"]["cost"]
    return math.inf if found is None else found


def whole(entry):
    """The summary of a whole object, before details: whose scale counted, kinds of maps, what was left out, cut and
    joined; "" for one part of which there is nothing to say."""
    scale = [f"in the scale of {entry['scale_of']}"] if "scale_of" in entry else []
    text = "; ".join([*scale, entry["whole"]["text"]]).removesuffix("; ")
    return text[:1].upper() + text[1:]


def numbers(entry):
    """(name, value) of what is measured over the whole object, and the sums of what is counted."""
    measured, whole = [part["main_map"] for part in entry["components"] if part["done"]], entry["whole"]
    size = math.inf if whole["size_range"] is None else whole["size_range"]
    return [
        ("Size range", f"{size:.3g} : 1" if size < 1000 else "1000+"),
        ("Angle distortion", f"{whole['mean_angle']:.2f} : 1"),
        ("Flipped triangles", str(sum(one["flipped_triangles"] for one in measured))),
        ("Collapsed triangles", str(sum(one["collapsed_triangles"] for one in measured))),
    ]


def _summary(entry):
    """Short lines for the panel."""
    parts, count = entry["components"], len(entry["maps"])
    yield "1 map" if count == 1 else f"{count} maps"
    yield from (cut["text"][0].upper() + cut["text"][1:] for cut in entry["repairs"]["cuts"])
    if joined := entry["repairs"]["joined_vertices"]["count"]:
        yield f"{joined:,} vertices at the places of others were joined"
    for index, part in enumerate(parts[:SUMMARISED], 1):
        yield f"Part {index}: {_topology(part)}" + ("" if part["done"] else ", skipped")
        if part["done"]:
            yield from (f"    {line}" for line in _result_lines(part))
    if len(parts) > SUMMARISED:
        yield f"... {holomorph.report.part_count(parts[SUMMARISED:])} more parts in the report"


def _topology(part):
    if "genus" not in part:
        return "no surface"
    loops, genus = part["boundary_count"], f"genus {part['genus']}"
    return genus if not loops else f"{genus}, {loops} boundary loop{'s' if loops > 1 else ''}"


def _result_lines(part):
    yield part["main_map"]["verdict"]["sentence"]
    yield from _tiling_lines(part["tiling"]) if "tiling" in part else [part["description"]]
    yield f"angle distortion {part['main_map']['mean_angle']:.4f}"
    if part.get("modulus") is not None:
        yield f"modulus {part['modulus']:.6g}"
        if part.get("modulus_bounds"):
            yield "    between {:.6g} and {:.6g}".format(*part["modulus_bounds"])
    if part["genus"] == 1 and part["boundary_count"] == 0 and part.get("period_matrix"):
        real, imaginary = part["period_matrix"][0][0]
        yield f"tau = {round(real, 4) + 0.0:.4f} + {imaginary:.4f} i"


def _tiling_lines(tiling):
    if tiling["turns"] != 1:
        yield f"size range {tiling['size_range']:.3g}"
        yield holomorph.quality.verdicts.special(0, tiling["turns"], len(tiling["cones"]), tiling["lines"])
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
