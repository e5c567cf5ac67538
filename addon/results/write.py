# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of a run, in Blender's main thread: maps are written to the objects and reported, also in sentences for the
user."""

from dataclasses import dataclass, field, replace

import numpy as np

from .. import compatibility, native
from ..maps import mapped, packing
from ..materials import material
from ..native import holomorph
from ..scene import gathering, mesh_io, stored_dials, targets, uv_maps
from ..solving.jobs import REFUSALS
from ..writing import transaction
from . import heat, report, tags

NAMED = 4  # parts that a message numbers
MOST_TOLD = 8  # messages at a time
UNUSED = "your choice was not used"
OVERLAP = "UV > Select Overlap shows where"
CLOSING_MODIFIERS = {"MIRROR", "SOLIDIFY", "SCREW", "ARRAY", "BOOLEAN", "REMESH", "WELD", "NODES", "SKIN"}


@dataclass(frozen=True)
class WriteOptions:
    """What is written besides the maps."""

    shown: int = 0  # 0 the main map, j the map of form j
    checker: bool = True  # whether the map is shown by a material
    texture: str = material.CHECKER  # what it shows
    checker_scale: float = 0.0  # squares, bricks, scales ... per UV unit; 0 lets the first object decide
    seams: bool = False
    shape: bool = False  # the conformal image in space
    empties: bool = False  # at poles and branch points
    size: float = 0.0  # width of an image of the texture on the surface; 0 for the number of squares
    own: object | None = None  # `user_texture.Own`: the texture is one of the user's
    together: int = 1  # objects whose tiles have one size
    repeats: int = 1  # images of the texture side by side in a tile, at least
    stored: dict = field(default_factory=dict)  # the dials of which the maps are made


def write(step, found, results, options, time_has_passed=False):
    """Writes the maps of every `mapped.MappedObject` and reports every other result; an object that is refused is not
    touched. Gives the `Outcome`.

    found : the `targets.Target`s; step : the `transaction.Step` of their objects
    time_has_passed : Blender was alive during the solve, so each mesh is compared with what was read
    """
    outcome = Outcome(objects=targets.objects(found))
    for target, result in zip(found, results):
        reason = _why_not(target, result, time_has_passed)
        if reason:
            outcome.refuse(target.name, reason)
        elif not result.done:
            outcome.skip(target.find(), result)
        else:
            with transaction.naming(target):
                _write_object(step, outcome, target, result, options)
    if outcome.done:
        report.store_text(outcome.entries)
        step.discard(material.unused_copies())
        outcome.notes += [f"{options.own.name}: {options.own.text}"] if options.own else []
    return outcome


def _why_not(target, result, time_has_passed):
    """Why nothing is written to an object, or ""."""
    if target.refused:
        return target.refused
    if isinstance(result, REFUSALS):
        return native.sentence(result)
    has_changed = target.has_changed(time_has_passed)
    return "it changed during the solve; please run it again" if has_changed else ""


def _write_object(step, outcome, target, made, options):
    obj, sharers, polygons = target.find(), target.find_sharers(), target.polygons
    if target.makes_object:
        obj = tags.modifier_result(step, obj)
        outcome.objects.append(obj)
    if made.main == mapped.ISLANDS:
        made = packing.packed(step.context, made)
    uv_maps.remember_shown(obj.data)
    written, shown, new_seams = _write_maps(obj.data, polygons, made, options)
    if options.checker:
        look = _look(made, options, shown is written[0] and bool(made.tiled))
        look = outcome.looks.setdefault((look.is_tiling, look.is_turned), look)
        covering = outcome.covering(shown, look)
        for each in (obj, *sharers):
            material.cover(each, covering)
    heat.refresh(obj)
    obj.data.update()
    users, kept = (obj, *gathering.others(obj)), stored_dials.kept(options.stored, made.request.poles, obj.data)
    for user in users:
        stored_dials.write(user, kept)
    options = replace(options, stored=stored_dials.of(obj))
    entry = report.object_report(obj, made, written, new_seams, options)
    entry = report.with_coarse_places(obj, polygons, entry)
    report.store(obj, entry)
    step.remove(tags.empties_of(obj))
    if options.empties:
        vertices, kinds = report.points(obj, whole=True)
        is_pole, is_marked = kinds == report.POLE, kinds != report.CONE
        tags.write_empties(step.context, obj, vertices[is_marked], is_pole[is_marked])
    outcome.add(obj, target, made, written, entry)


def _write_maps(mesh, polygons, made, options):
    """Maps, seams and shape; gives the `uv_maps.WrittenMap`s, the one that is shown and the number of new seams."""
    if polygons.faces is None:
        uv_maps.remove_maps(mesh)
    written = [uv_maps.write_map(mesh, polygons, name, uv) for name, uv in made.maps()]
    shown = written[min(options.shown, len(written) - 1)]
    uv_maps.add_own_maps(mesh, [w.name for w in written])
    uv_maps.show_map(mesh, shown.name)
    new_seams = mesh_io.add_seams(mesh, _cuts(mesh, polygons, made)) if options.seams else 0
    shape = mapped.shape_points(made.solved) if options.shape else None
    if shape is not None:
        uv_maps.write_shape(mesh, shape)
    return written, shown, new_seams


def _cuts(mesh, polygons, made):
    """(#S,2) vertices of the object: where the main map is cut, and where the mapped faces end."""
    islands = packing.cuts([part.component.surface for part in made.parts])
    return np.concatenate([islands, targets.border(mesh, polygons), *(part.seams for part in made.done)])


def _look(made, options, is_tiling):
    """A tiling gets as many images in each tile as come nearest to the wanted number of squares. Elsewhere density is
    to be seen: the squares are those of density 1, so that there are more of them where it is higher."""
    if is_tiling:
        cells = material.cells(options.texture)
        cells *= max(options.repeats, round(options.checker_scale / cells))
        turns = max([part.map.turns for part in made.tiled])
        own = options.own and options.own.on_turned(turns)
        return material.Look(options.texture, cells, made.unit_length, True, own, turns != 1)
    plain = made.of_forms()
    cells = options.checker_scale
    if options.size and plain.unit_length:
        cells = material.cells(options.texture) * plain.unit_length / options.size
    cells = cells or plain.squares_that_fit(material.across(options.texture))
    return material.Look(options.texture, cells, plain.unit_length, own=options.own)


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
        return round(sum(tiling["tiles"] for entry in self.entries for tiling in report.tilings_of(entry)))

    def covering(self, shown, look):
        """The material that shows a `uv_maps.WrittenMap`, the same for all objects."""
        key = shown.name, shown.kind, look
        if key not in self.coverings:
            self.coverings[key] = material.showing(shown.name, shown.kind == "attribute", look, self.objects)
        return self.coverings[key]

    def refuse(self, name, sentence):
        self.problems.append(f"{name}: {sentence}")
        self.entries.append(report.refusal_report(name, sentence))

    def skip(self, obj, made):
        """Adds an object of which no part has a map."""
        self.problems += _problems(obj, made)
        self.entries.append(report.object_report(obj, made))

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
