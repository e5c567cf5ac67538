# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run did: the report, as JSON in a custom property of each object and in a text datablock, and sentences for
the user."""

import json
from dataclasses import asdict, dataclass, field, replace

import bpy
import numpy as np

from .. import compatibility, native
from ..materials import material
from ..native import holomorph
from ..scene import gathering, mesh_io, stored_dials, uv_maps
from . import stored

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
    others = gathering.others(obj)
    _store_on_object(obj, entry)
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
    stored_dials.know(obj, stored.values(entry), entry["dials"]["stored"])


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


NAMED = 4  # parts that a message numbers
MOST_TOLD = 8  # messages at a time
UNUSED = "your choice was not used"
OVERLAP = "UV > Select Overlap shows where"
CLOSING_MODIFIERS = {"MIRROR", "SOLIDIFY", "SCREW", "ARRAY", "BOOLEAN", "REMESH", "WELD", "NODES", "SKIN"}


@dataclass
class Outcome:
    """What a run did: names of the objects that got maps, sentences for the user, the report's entries."""

    done: list = field(default_factory=list)
    problems: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    entries: list = field(default_factory=list)
    looks: dict = field(default_factory=dict)  # `material.Look`s for all objects, by whether of tilings, and turned
    coverings: dict = field(default_factory=dict)  # materials by what they show
    objects: list = field(default_factory=list)  # that these are for

    @property
    def tiles(self):
        """How many tiles all tilings have, a whole number."""
        return round(sum(tiling["tiles"] for entry in self.entries for tiling in stored.tilings_of(entry)))

    def covering(self, shown, look):
        """The material that shows a `uv_maps.WrittenMap`, the same for all objects."""
        key = shown.name, shown.kind, look
        if key not in self.coverings:
            self.coverings[key] = material.showing(shown.name, shown.kind == "attribute", look, self.objects)
        return self.coverings[key]

    def refuse(self, name, sentence):
        self.problems.append(f"{name}: {sentence}")
        self.entries.append(refusal_report(name, sentence))

    def skip(self, obj, made):
        """Adds an object of which no part has a map."""
        self.problems += _problems(obj, made)
        self.entries.append(object_report(obj, made))

    def add(self, obj, target, made, written, entry):
        """Adds an object that got its maps."""
        self.done.append(obj.name)
        self.entries.append(entry)
        self.judge(obj, made, entry)
        self.problems += _problems(obj, made)
        if target.polygons.faces is None:
            self.notes += _modifier_notes(obj, made.solved)
        extra = sum(w.kind == "attribute" for w in written)
        if extra:
            maps_are = "1 map is a corner attribute" if extra == 1 else f"{extra} maps are corner attributes"
            self.notes.append(f"{obj.name}: {maps_are}, because no UV map slots are free")
        if obj.override_library is not None:
            self.notes.append(f"{obj.name} is a library override: its report is lost when the file is reopened")
        self.notes += [target.note] if target.note else []

    def judge(self, obj, made, entry):
        """Adds the verdict on an object's map: among the problems where no texture can be put on."""
        found, whole = holomorph.Verdict(**entry["verdict"]), entry["whole"]["text"]
        told = ". ".join(filter(None, [whole, *holomorph.quality.verdicts.told(entry)]))
        (self.notes if found.is_fit else self.problems).append(f"{obj.name}: {told}")
        limit = holomorph.quality.verdicts.OVERLAPPING[1]
        overlapping = [
            str(index)
            for index, part in enumerate(made.parts, 1)
            if part.map and (part.map.quality.overlapping_part or 0.0) > limit
        ]
        if overlapping:
            which = _numbered("island", overlapping)
            which += " overlaps itself" if len(overlapping) == 1 else " overlap themselves"
            self.problems.append(f"{obj.name}: {which}: {OVERLAP}")
        count = entry["faces_without_area"]
        if count:
            self.problems.append(f"{obj.name}: {count} faces are too small in the map for Blender's single precision")


def in_short(sentences):
    """Sentences about objects, "name: what", as messages: one for all objects of which the same is said, and where
    there would be more than `MOST_TOLD`, one with their number."""
    names = {}
    for sentence in sentences:
        name, _, what = sentence.partition(": ")
        names.setdefault(what or sentence, []).append(name if what else "")
    told = [_of_all(found, what) for what, found in names.items()]
    if len(told) <= MOST_TOLD:
        return told
    return [f"{len(sentences):,} messages; the panel of each object has its own. The first: {sentences[0]}"]


def _of_all(names, what):
    more = f" and {len(names) - 1:,} more" if len(names) > 1 else ""
    return f"{names[0]}{more}: {what}" if names[0] else what


def _problems(obj, made):
    """What was not done, or not as it was chosen; the parts that are not surfaces. One sentence for each reason."""
    told = {}
    for index, part in enumerate(made.parts, 1):
        reasons = {"skipped": part.skipped, UNUSED: part.component.note}
        reasons["not seamless"] = part.not_seamless
        for what, why in reasons.items():
            if why:
                told.setdefault((what, why), []).append(str(index))
    for (what, why), indices in told.items():
        which = "" if len(made.parts) == 1 else f"{_numbered('part', indices)} of {len(made.parts)}"
        words = (what, "on" if which else "", which) if what == UNUSED else (which, what)
        yield f"{obj.name}: {' '.join(filter(None, words))}: {why}"
    left = {}
    for refused in made.solved.surface.refused:
        left.setdefault(native.sentence(refused.reason), []).append(len(refused.faces))
    yield from (f"{obj.name}: {_faces(sum(counts))} left out: {reason}" for reason, counts in left.items())


def _numbered(noun, indices):
    """A noun with its numbers: "part 3", "parts 1, 4", or "30 parts"."""
    if len(indices) > NAMED:
        return f"{len(indices)} {noun}s"
    return f"{noun}{'s' * (len(indices) > 1)} {', '.join(indices)}"


def _faces(count):
    return "1 face" if count == 1 else f"{count:,} faces"


def _modifier_notes(obj, solved):
    closing = [m.name for m in obj.modifiers if m.type in CLOSING_MODIFIERS and not compatibility.is_auto_smooth(m)]
    if closing and any(c.surface.boundary_count for c in solved.components):
        yield f"{obj.name}: modifiers are ignored: switch With Modifiers on if {closing[0]!r} closes the surface"


def with_coarse_places(obj, polygons, entry):
    """The report's entry with the places that the main map leaves coarse, where it is uneven, and how many faces are
    too small in it for the single precision of Blender's UV maps."""
    ratios = [part["main_map"]["size_range"] for part in entry["components"] if part["done"]]
    if all(ratio is not None and ratio <= holomorph.UNEVEN[-1] for ratio in ratios):
        return entry | {"coarse_places": [], "faces_without_area": 0}
    distortion = holomorph.distortion
    found = distortion.measure(polygons, uv_maps.read_corners(obj.data, polygons, entry["maps"][0]["name"]))
    places = stored.coarse_places(obj, polygons, found.density)
    without_area = int(np.count_nonzero(found.angle >= distortion.COLLAPSED))
    return entry | {"coarse_places": places, "faces_without_area": without_area}
