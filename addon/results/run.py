# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of a run, in Blender's main thread: what was solved is written to the objects and reported."""

from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from .. import compatibility, native
from ..maps import coarse, distortion, maps, packing, seamless, tiling
from ..materials import material, patterns
from ..scene import faces, mesh_edges, mesh_io
from . import heat, report, restore, stand_in, tile_report

OVERLAPS = "overlaps itself: UV > Select Overlap shows where"
CLOSING_MODIFIERS = {"MIRROR", "SOLIDIFY", "SCREW", "ARRAY", "BOOLEAN", "REMESH", "WELD", "NODES", "SKIN"}


@dataclass
class Outcome:
    """What a run did: names of the objects that got maps, sentences for the user, the report's entries."""

    done: list = field(default_factory=list)
    problems: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    entries: list = field(default_factory=list)
    forms: int = 0
    looks: dict = field(
        default_factory=dict
    )  # `material.Look` of tilings (True) and of other maps, shared by all objects

    def refuse(self, name, sentence):
        self.problems.append(f"{name}: {sentence}")
        self.entries.append(report.refusal_report(name, sentence))


@contextmanager
def object_mode(context):
    """Leaves edit mode for the time of writing, for Blender gives no UV layers in it."""
    if context.mode != "EDIT_MESH":
        yield
        return
    edited = [o for o in context.view_layer.objects if o.mode == "EDIT"]
    selected = list(compatibility.selected_objects(context))
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        for obj in selected:
            obj.select_set(obj in edited)
        for obj in edited:
            obj.select_set(True)
        bpy.ops.object.mode_set(mode="EDIT")
        for obj in selected:
            obj.select_set(True)


@dataclass(frozen=True)
class WriteOptions:
    """What is written besides the maps."""

    shown: int = 0  # 0 the main map, j the map of form j
    checker: bool = True  # whether the map is shown by a material
    texture: str = material.CHECKER  # what it shows
    checker_scale: float = 0.0  # squares, bricks, scales ... per UV unit; 0 lets the first object decide
    seams: bool = False
    shape: bool = False  # the conformal image in space


def write(context, targets, results, map_options, write_options, time_has_passed=False):
    """Writes the maps of every `seamless.MappedObject` and reports every other; an object that is refused is not
    touched."""

    def write_object(outcome, obj, polygons, mapped):
        if mapped.done:
            values, options = _values(context, mapped, map_options)
            _write_object(outcome, obj, polygons, mapped, values, options, write_options)
        else:
            _report_all_skipped(outcome, obj, mapped.solved, map_options)

    return write_each(context, targets, results, write_object, time_has_passed)


def _values(context, mapped, options):
    """The maps as `seamless.map_values` has them, and the options with the density of the main one."""
    if options.main != maps.ISLANDS:
        return seamless.map_values(mapped.solved, options, mapped.tiled), options
    main, options = packing.packed(context, mapped.solved, options)
    return [(maps.MAIN_MAP, main)], options


def write_each(context, targets, results, write_object, time_has_passed=False):
    """Calls `write_object(outcome, obj, polygons, result)` for every object that is not refused.

    `time_has_passed`: Blender was alive during the solve, so each mesh is compared with what was read.
    """
    outcome = Outcome()
    refusals = native.refusals()
    with object_mode(context):
        for target, result in zip(targets, results):
            obj = target.find()
            if target.refused:
                outcome.refuse(target.name, target.refused)
            elif isinstance(result, refusals):
                outcome.refuse(target.name, native.sentence(result))
            elif target.has_changed(time_has_passed):
                outcome.refuse(target.name, "it was changed while it was solved; please run it again")
            else:
                obj = stand_in.make(context, obj) if result.done and target.makes_object else obj
                write_object(outcome, obj, target.polygons, result)
                outcome.notes += [target.note] if target.note and result.done else []
        if outcome.done:
            report.store_text(outcome.entries)
    return outcome


def _problems(obj, solved, tiled):
    """What was not done, or not as it was chosen."""
    refused = {id(part.component): part.reason for part in tiled.parts if part.tiling is None}
    count = len(solved.components)
    for index, component in enumerate(solved.components, 1):
        part = "" if count == 1 else f"part {index} of {count} "
        if component.structure is None:
            yield f"{obj.name}: {part}skipped: {native.sentence(component.reason)}"
        if component.note:
            yield f"{obj.name}: {part}made without your choice: {native.sentence(component.note)}"
        if id(component) in refused:
            yield f"{obj.name}: {part}not seamless: {native.sentence(refused[id(component)])}"
    yield from surface_problems(obj, solved.surface)


def with_coarse_places(obj, polygons, entry):
    """The report's entry with the places that the main map leaves coarse, where it is uneven, and how many faces are
    too small in it for the single precision of Blender's UV maps."""
    ratios = [part["main_map"]["density_ratio"] for part in entry["components"] if part["done"]]
    if all(ratio is not None and ratio <= native.load().UNEVEN[0] for ratio in ratios):
        return entry | {"coarse_places": [], "faces_without_area": 0}
    name = entry["maps"][0]["name"]
    found = coarse.measured(polygons, mesh_io.read_corners(obj.data, polygons, name))
    places = [vars(place) for place in coarse.places(obj, polygons, found.density)]
    without_area = int(np.count_nonzero(found.angle >= distortion.MOST_ANGLE))
    return entry | {"coarse_places": places, "faces_without_area": without_area}


def judge(outcome, obj, entry):
    """Adds the verdict on an object's map: among the problems where no texture can be put on."""
    found = report.verdict(entry)
    (outcome.notes if found.is_fit else outcome.problems).append(f"{obj.name}: {found.text}")
    for index, part in enumerate(entry.get("components", []), 1):
        if part["done"] and (part["main_map"]["overlapping_part"] or 0.0) > native.load().verdicts.OVERLAPPING[0]:
            outcome.problems.append(f"{obj.name}: island {index} {OVERLAPS}")
    count = entry.get("faces_without_area", 0)
    if count:
        outcome.problems.append(f"{obj.name}: {count} faces are too small in the map for Blender's single precision")


def surface_problems(obj, surface):
    """The parts that are no surface."""
    for refused in surface.refused:
        yield f"{obj.name}: {len(refused.faces)} faces left out: {native.sentence(refused.reason)}"
    if surface.is_unwelded:
        yield f"{obj.name}: every face is apart; Mesh > Merge > By Distance joins those that touch"


def _modifier_notes(obj, solved):
    closing = [m.name for m in obj.modifiers if m.type in CLOSING_MODIFIERS and not compatibility.is_auto_smooth(m)]
    if closing and any(c.surface.boundary_count for c in solved.components):
        yield f"{obj.name}: modifiers are ignored: take Map with Modifiers if {closing[0]!r} closes the surface"


def _report_all_skipped(outcome, obj, solved, options):
    nothing = tiling.TiledObject(solved, ())
    outcome.problems += _problems(obj, solved, nothing)
    outcome.entries.append(_entry(obj, solved, nothing, [], 0, options))


def _entry(obj, solved, tiled, written, new_seams, options):
    tilings = {id(part.component): tile_report.part_report(part) for part in tiled.done}
    parts = [tilings.get(id(c)) or report.component_report(c, options) for c in solved.components]
    return report.object_report(obj, solved, written, new_seams, options, parts)


def _write_object(outcome, obj, polygons, mapped, values, map_options, options):
    mesh, solved, tiled = obj.data, mapped.solved, mapped.tiled
    restore.remember(mesh)
    if polygons.faces is None:
        mesh_io.remove_maps(mesh)
    written = [mesh_io.write_map(mesh, polygons, name, uv) for name, uv in values]
    mesh_io.add_own_maps(mesh, [w.name for w in written])
    shown = written[min(options.shown, len(written) - 1)]
    mesh_io.show_map(mesh, shown.name)
    cuts = [_seam_pairs(solved, tiled), faces.border(mesh, polygons)] if options.seams else []
    new_seams = mesh_edges.add_seams(mesh, np.concatenate(cuts)) if cuts else 0
    shape = maps.shape_points(solved) if options.shape else None
    if shape is not None:
        mesh_io.write_shape(mesh, shape)
    if options.checker:
        is_tiling = bool(tiled.done) and shown is written[0]
        look = _tiling_look(tiled, options) if is_tiling else _look(solved, map_options, options)
        look = outcome.looks.setdefault(is_tiling, look)
        material.cover(obj, material.showing(shown.name, shown.kind == "attribute", look))
    heat.refresh(obj)
    mesh.update()
    entry = with_coarse_places(obj, polygons, _entry(obj, solved, tiled, written, new_seams, map_options))
    report.store_on_object(obj, entry)
    outcome.entries.append(entry)
    outcome.done.append(obj.name)
    outcome.forms = max(outcome.forms, solved.form_count)
    outcome.problems += _problems(obj, solved, tiled)
    judge(outcome, obj, entry)
    outcome.notes += _modifier_notes(obj, solved) if polygons.faces is None else []
    extra = sum(w.kind == "attribute" for w in written)
    if extra:
        maps_are = "1 map is a corner attribute" if extra == 1 else f"{extra} maps are corner attributes"
        outcome.notes.append(f"{obj.name}: {maps_are}, for want of UV map slots")


def _look(solved, map_options, options):
    # Density is to be seen: the squares are those of density 1, so that there are more of them where it is higher.
    cells = options.checker_scale or maps.squares_that_fit(solved, replace(map_options, density=1.0))
    return material.Look(options.texture, cells, maps.unit_length(solved, map_options))


def _tiling_look(tiled, options):
    """One image of a texture in each tile, or as many as the wanted number of squares comes nearest to."""
    cells = material.CHECKER_CELLS if options.texture == material.CHECKER else patterns.TEXTURES[options.texture].cells
    repeats = max(1, round(options.checker_scale / cells))
    return material.Look(options.texture, repeats * cells, tiled.unit_length, is_tiling=True)


def _seam_pairs(solved, tiled):
    """(#S,2) vertices of the object: where the main map is cut."""
    others = [c for c in seamless.others(solved, tiled) if c.structure is not None]
    return np.concatenate(
        [packing.cuts([c.surface for c in solved.components])]
        + [c.structure.edges[c.structure.seams] for c in others]
        + [part.vertices(part.tiling.seams) for part in tiled.done]
    )
