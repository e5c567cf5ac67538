# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: what was computed, as JSON in a custom property of each object and in a text datablock."""

import functools
import json
import math

import bpy
import numpy as np

from . import maps, native

PROPERTY = "holomorph_report"
SUMMARISED = 8  # parts that the panel shows
PROPERTY_LIMIT = 1_000_000  # characters; reached at a genus of about 120
MATRICES = ("period_matrix", "period_bounds", "capacity_matrix", "capacity_bounds")
COLLAPSED = 1e3  # a mean distortion that only a triangle without area gives
LISTED = 20  # elements of a repair that the report names
TEXT = "Holomorphic Report"


def component_report(component, options):
    """One connected part: topology, and either why it was skipped or what was computed."""
    surface = component.surface
    entry = {
        "faces": len(surface.face_index),
        "vertices": len(surface.vertex_index),
        "genus": surface.genus,
        "boundary_count": surface.boundary_count,
        "done": component.structure is not None,
    }
    if component.note:
        entry["not_followed"] = component.note
    if component.structure is None:
        return {**entry, "skipped": component.reason}
    structure = component.structure
    quality = maps.main_quality(component, options)
    return {
        **entry,
        "description": structure.description,
        "forms": component.form_count,
        **structure.invariants(),
        "residuals": structure.residuals,
        "solver": structure.solver,
        "timings": structure.timings,
        "seam_edges": len(structure.seams),
        "balanced_coefficients": component.balanced,
        "main_map": {
            "mean_angle": quality.mean_angle,
            "density_ratio": quality.density_ratio,
            "flipped": quality.flipped,
        },
    }


def object_report(obj, solved, written, new_seams, options):
    """One object: its maps as written and its components."""
    return {
        "object": obj.name,
        "mesh": obj.data.name,
        "vertices": len(solved.surface.vertices),
        "faces": len(solved.surface.face_offsets) - 1,
        "done": bool(solved.done),
        "maps": [{"name": w.name, "stored_as": w.kind} for w in written],
        "seams_added": new_seams,
        "repairs": _repairs(solved.surface.repairs),
        "seconds": solved.seconds,
        "components": [component_report(c, options) for c in solved.components],
    }


def refusal_report(name, sentence):
    """One object that was left untouched, and why."""
    return {"object": name, "done": False, "refused": sentence}


def as_json(value, indent=None):
    """Standard JSON of NumPy arrays, dataclasses and numbers; what is not finite becomes null."""
    return json.dumps(_plain(value), indent=indent, allow_nan=False)


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
def summary(stored):
    """Short lines for the panel out of a stored report; none if someone has edited it."""
    try:
        return _summary(json.loads(stored))
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
    loops = part["boundary_count"]
    return f"genus {part['genus']}" + ("" if not loops else ", 1 hole" if loops == 1 else f", {loops} holes")


def _result_lines(part):
    yield part["description"]
    angle = part["main_map"]["mean_angle"]  # none where it is infinite
    collapsed = angle is None or angle > COLLAPSED
    yield "a UV triangle has collapsed" if collapsed else f"angle distortion {angle:.4f}"
    if part.get("modulus") is not None:
        yield f"modulus {part['modulus']:.6g}"
        yield "    between {:.6g} and {:.6g}".format(*part["modulus_bounds"])
    if part["genus"] == 1 and part["boundary_count"] == 0 and "period_matrix" in part:
        real, imaginary = part["period_matrix"][0][0]
        yield f"tau = {round(real, 4) + 0.0:.4f} + {imaginary:.4f} i"


def _repairs(repairs):
    """Of long lists of elements the length and the beginning."""
    return {
        name: value if np.ndim(value) == 0 else {"count": len(value), "first": value[:LISTED]}
        for name, value in vars(repairs).items()
    }


def _plain(value):
    if isinstance(value, np.ndarray) and np.iscomplexobj(value):
        return {"real": _plain(value.real), "imag": _plain(value.imag)}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, complex):
        return {"real": _plain(value.real), "imag": _plain(value.imag)}
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (str, int)):
        return value
    return {k: _plain(getattr(value, k)) for k in _public_names(value)}


def _public_names(value):
    """The fields of a result object that is not a plain container."""
    if hasattr(value, "__dataclass_fields__"):
        return [k for k in value.__dataclass_fields__ if not k.startswith("_")]
    if hasattr(value, "_fields"):
        return value._fields
    return [k for k in vars(value) if not k.startswith("_")]
