# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: what was computed, as JSON in a custom property of each object and in a text datablock."""

import json
from dataclasses import asdict

import bpy

from ..maps.options import TILING
from ..native import holomorph
from ..scene import faces, gathering, mesh_io

PROPERTY = "holomorph_report"
PROPERTY_LIMIT = 1_000_000  # characters; reached at a genus of about 120
MOST_OTHERS = 100  # objects with one mesh that get its report, besides the one that was mapped
MATRICES = ("period_matrix", "period_bounds", "capacity_matrix", "capacity_bounds")
TEXT = "Holomorphic Report"


def object_report(obj, made, written=(), new_seams=0, write_options=None):
    """One object: its maps as written, the options with which they were, and the report of each part."""
    package, solved = holomorph.report, made.solved
    parts = [_part_report(part) for part in made.parts]
    parts += [package.refused_report(refused) for refused in solved.surface.refused]
    repairs = faces.repairs(solved)
    dials = asdict(made.options)
    asked = dials.pop("tiling")
    del asked["allowed"]  # a vertex group of the object says it
    entry = {
        "object": obj.name,
        "mesh": obj.data.name,
        "shape_key": mesh_io.shape_key(obj.data),
        "vertices": len(solved.polygons.vertices),
        "faces": solved.polygons.face_count,
        "is_selection": solved.polygons.faces is not None,
        "done": bool(made.done),
        "maps": [{"name": w.name, "stored_as": w.kind} for w in written],
        "dials": dials | (asdict(write_options) if write_options else {}),
        "seams_added": new_seams,
        **package.whole_report(made.part_maps, parts, repairs),
        "repairs": package.repairs_report(repairs),
        "seconds": solved.seconds,
        "components": parts,
    }
    return entry | ({"asked": asked} if made.options.main == TILING else {})


def _part_report(part):
    """The package's report of one `mapped.MappedPart`, and the choice that was not followed on it."""
    package, component = holomorph.report, part.component
    entry = package.skipped_report(component.surface, part.skipped) if part.skipped else package.part_report(part.map)
    return entry | ({"not_followed": component.note} if component.note else {})


def refusal_report(name, sentence):
    """One object that was left untouched, and why."""
    return {"object": name, "done": False, "refused": sentence}


def as_json(value, indent=None):
    """Standard JSON of a report."""
    return json.dumps(value, indent=indent, allow_nan=False)


def store(obj, entry):
    """The custom property of an object that was mapped, and of others with its mesh, whose scale may be another; of so
    many of these that a file stays small."""
    others = gathering.others(obj)
    _store_on_object(obj, entry)
    for other in others[:MOST_OTHERS]:
        scale = {"scale_of": obj.name} if gathering.has_other_scale(obj, other) else {}
        _store_on_object(other, {**entry, "object": other.name, **scale})
    for other in others[MOST_OTHERS:]:
        other.pop(PROPERTY, None)  # it told of an earlier map


def _store_on_object(obj, entry):
    """Stores the entry without matrices that would make the property long: they are in the text as well."""
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
        "holomorph": getattr(holomorph, "__version__", ""),
        "blender": bpy.app.version_string,
        "objects": entries,
    }
