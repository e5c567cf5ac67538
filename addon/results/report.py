# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: what was computed, as JSON in a custom property of each object and in a text datablock."""

import functools
import json

import bpy

from .. import native
from ..maps import maps
from ..scene import faces

PROPERTY = "holomorph_report"
SUMMARISED = 8  # parts that the panel shows
SHOWN_PERIODS = 4  # likewise, of each part
PROPERTY_LIMIT = 1_000_000  # characters; reached at a genus of about 120
MATRICES = ("period_matrix", "period_bounds", "capacity_matrix", "capacity_bounds")
COLLAPSED = 1e3  # a mean distortion that only a triangle without area gives
TEXT = "Holomorphic Report"


def object_report(obj, solved, written, new_seams, options, components):
    """One object: its maps as written, the options with which they were, and the report of each component."""
    package = native.load().report
    surface = solved.surface
    return {
        "object": obj.name,
        "mesh": obj.data.name,
        "vertices": len(solved.polygons.vertices),
        "faces": solved.polygons.face_count,
        "is_selection": solved.polygons.faces is not None,
        "done": bool(solved.done),
        "maps": [{"name": w.name, "stored_as": w.kind} for w in written],
        "dials": vars(options),
        "seams_added": new_seams,
        "verdict": package.overall_report(components, surface.is_unwelded),
        "repairs": package.repairs_report(faces.repairs(solved)),
        "seconds": solved.seconds,
        "components": components + [package.refused_report(refused) for refused in surface.refused],
    }


def component_report(component, options):
    """The package's report of one component, and the choice that was not followed on it."""
    package = native.load().report
    if component.structure is None:
        entry = package.skipped_report(component.surface, component.reason)
    else:
        main_map = maps.main_map(component, options).report
        entry = package.component_report(component.surface, component.structure, main_map)
    return entry | not_followed(component)


def not_followed(component):
    """The choice that was not followed, if there is one."""
    return {"not_followed": component.note} if component.note else {}


def refusal_report(name, sentence):
    """One object that was left untouched, and why."""
    return {"object": name, "done": False, "refused": sentence}


def as_json(value, indent=None):
    """Standard JSON of a report."""
    return json.dumps(value, indent=indent, allow_nan=False)


def store_on_object(obj, entry):
    """The custom property; without the matrices where they would make it long, for they are in the text as well."""
    text = as_json(entry)
    if len(text) > PROPERTY_LIMIT:
        parts = [{k: v for k, v in part.items() if k not in MATRICES} for part in entry["components"]]
        text = as_json({**entry, "components": parts})
    obj[PROPERTY] = text


def store_text(entries):
    """Replaces the text datablock with the report of all objects of one run."""
    text = bpy.data.texts.get((TEXT, None)) or bpy.data.texts.new(TEXT)
    text.from_string(as_json(run_report(entries), indent=1))


def run_report(entries):
    return {
        "holomorph": getattr(native.load(), "__version__", ""),
        "blender": bpy.app.version_string,
        "objects": entries,
    }


@functools.lru_cache(maxsize=16)
def parsed(stored):
    """A stored report; an empty one if someone has edited it so that it is none."""
    try:
        entry = json.loads(stored)
    except (ValueError, TypeError):
        return {}
    return entry if isinstance(entry, dict) else {}


@functools.lru_cache(maxsize=16)
def summary(stored):
    """Short lines for the panel out of a stored report; none if someone has edited it."""
    try:
        return _summary(parsed(stored))
    except (ValueError, KeyError, TypeError, IndexError):
        return []


def _summary(entry):
    parts, count = entry["components"], len(entry["maps"])
    lines = ["1 map" if count == 1 else f"{count} maps"]
    for index, part in enumerate(parts[:SUMMARISED], 1):
        lines.append(f"Part {index}: {_topology(part)}" + ("" if part["done"] else ", skipped"))
        if part["done"]:
            lines += [f"    {line}" for line in _result_lines(part)]
    if len(parts) > SUMMARISED:
        lines.append(f"... {len(parts) - SUMMARISED} more parts in the report")
    return lines


def _topology(part):
    if "genus" not in part:
        return "no surface"
    loops = part["boundary_count"]
    return f"genus {part['genus']}" + ("" if not loops else ", 1 hole" if loops == 1 else f", {loops} holes")


def verdict(entry):
    """The package's `Verdict` on an object or a part in a report; None where there is none."""
    found = entry.get("verdict")
    return native.load().Verdict(**found) if found else None


def sentence(part):
    """The verdict on the main map of a part, in short."""
    return part["main_map"]["verdict"]["sentence"]


def tiling_lines(tiling):
    """The numbers that the panels show of a part's tiling."""
    yield f"added distortion {tiling['added_distortion']:.4f}"
    yield f"density, 95 : 5 % = {tiling['density_ratio']:.3g}"
    yield f"poles: {len(tiling['poles'])}, branch points: {len(tiling['zeros'])}"
    if tiling["periods"]:
        shown = ", ".join(f"({u}, {v})" for u, v in tiling["periods"][:SHOWN_PERIODS])
        yield f"periods: {shown}" + (", ..." if len(tiling["periods"]) > SHOWN_PERIODS else "")


def _result_lines(part):
    yield sentence(part)
    yield from tiling_lines(part["tiling"]) if "tiling" in part else [part["description"]]
    angle = part["main_map"]["mean_angle"]  # none where it is infinite
    collapsed = angle is None or angle > COLLAPSED
    yield "a UV triangle has collapsed" if collapsed else f"angle distortion {angle:.4f}"
    if part.get("modulus") is not None:
        yield f"modulus {part['modulus']:.6g}"
        if part["modulus_bounds"] is not None:
            yield "    between {:.6g} and {:.6g}".format(*part["modulus_bounds"])
    if part["genus"] == 1 and part["boundary_count"] == 0 and "period_matrix" in part:
        real, imaginary = part["period_matrix"][0][0]
        yield f"tau = {round(real, 4) + 0.0:.4f} + {imaginary:.4f} i"
