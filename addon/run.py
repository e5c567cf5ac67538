# SPDX-License-Identifier: GPL-3.0-or-later
"""The main job in Blender's main thread: collect objects, (a `Job` solves), write what was solved."""

from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from . import choices, compatibility, maps, material, mesh_io, native, report, solve

SAME_SCALE = 1e-5  # relative: matrices of objects are float32
MOST_PICKED = 64  # vertices; a larger selection is no choice of single vertices
CLOSING_MODIFIERS = {"MIRROR", "SOLIDIFY", "SCREW", "ARRAY", "BOOLEAN", "REMESH", "WELD", "NODES", "SKIN"}


@dataclass(frozen=True)
class Target:
    """An object to treat; it is found again by name, since Python's references do not survive everything."""

    name: str
    library: str | None
    polygons: mesh_io.Polygons | None
    chosen: choices.Choices = choices.Choices()
    refused: str = ""
    note: str = ""

    def find(self):
        return bpy.data.objects.get((self.name, self.library))


@dataclass(frozen=True)
class Request:
    """What is asked of every object of a run; the choices on each mesh are made of it."""

    use: str = choices.NONE  # of the selected vertices
    vertices: tuple | None = None  # instead of the selected ones
    residues: tuple = ()
    cut_at_seams: bool = False
    boundary: str = "natural"
    solver: str = "auto"


@dataclass
class Outcome:
    """What a run did: names of the objects that got maps, sentences for the artist, the report's entries."""

    done: list = field(default_factory=list)
    problems: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    entries: list = field(default_factory=list)
    forms: int = 0
    squares: float = 0.0

    def refuse(self, name, sentence):
        self.problems.append(f"{name}: {sentence}")
        self.entries.append(report.refusal_report(name, sentence))


def mesh_objects(context):
    """The mesh objects the operator is about, the active one first."""
    if context.mode == "EDIT_MESH":
        objects = compatibility.objects_being_edited(context)
    else:
        objects = [o for o in compatibility.selected_objects(context) if o.type == "MESH"]
    active = context.view_layer.objects.active
    return sorted(objects, key=lambda o: o != active)


def collect(objects, request=Request()):
    """Reads the polygons and the choices of every object; of those that share a mesh, the first speaks for it."""
    targets, first = [], {}
    for obj in objects:
        mesh = obj.data
        library = obj.library.filepath if obj.library else None
        if mesh in first:
            index, other = first[mesh]
            if not np.allclose(_metric(obj), _metric(other), rtol=0, atol=SAME_SCALE):
                note = f"{obj.name} has the same mesh in another scale; the scale of {other.name} counts"
                targets[index] = replace(targets[index], note=note)
            continue
        first[mesh] = len(targets), obj
        if mesh.library is not None:
            refused = "its mesh is linked from another file; make it local first"
            targets.append(Target(obj.name, library, None, refused=refused))
            continue
        targets.append(Target(obj.name, library, read(obj), _choices(obj, request)))
    return targets


def _choices(obj, request):
    """What was chosen on this object; `read` has brought pending edits into the mesh before."""
    seams = mesh_io.seam_vertices(obj.data) if request.cut_at_seams else np.empty((0, 2), np.int64)
    selected = request.vertices if request.vertices is not None else _selected(obj, request.use)
    return choices.Choices(request.use, tuple(selected), request.residues, seams, request.boundary, request.solver)


def _selected(obj, use):
    """The selected vertices. Automatic use takes single vertices in edit mode, not faces or edges that are selected."""
    if use == choices.NONE or (use == choices.AUTOMATIC and obj.mode != "EDIT"):
        return ()
    selected = mesh_io.selected_vertices(obj.data)
    if use == choices.AUTOMATIC and (len(selected) > MOST_PICKED or mesh_io.are_neighbours(obj.data, selected)):
        return ()
    return selected.tolist()


def _linear(obj):
    return np.array(obj.matrix_world, np.float64)[:3, :3]


def _metric(obj):
    """How the object's matrix changes shapes: equal for matrices that differ by rotation, reflection or factor."""
    metric = _linear(obj).T @ _linear(obj)
    size = np.trace(metric)
    return metric / size if size > 0 else metric


def with_positions(target, vertices):
    """The same target solved with these (#V,3) float64 positions, where a file knows them better than Blender."""
    return replace(target, polygons=replace(target.polygons, vertices=vertices))


def tasks(targets):
    return [solve.Task(t.polygons, t.chosen) for t in targets if not t.refused]


def align(targets, results):
    """The results in the order of all targets; a target that was refused at once has none."""
    solved = iter(results)
    return [None if t.refused else next(solved) for t in targets]


def read(obj):
    """The polygons as the artist sees them: with the object's scale, with pending edits, without modifiers."""
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    return mesh_io.read_polygons(obj.data, _linear(obj))


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
    """What is written beside the maps."""

    shown: int = 0  # 0 the main map, j the map of form j
    checker: bool = True
    checker_scale: float = 0.0  # squares per UV unit; 0 lets the first object decide
    seams: bool = False
    shape: bool = False  # the conformal image in space


def write(context, targets, results, map_options, write_options, time_has_passed=False):
    """Writes every solved object and reports every other; an object that is refused is not touched.

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
                outcome.refuse(target.name, _sentence(result))
            elif obj is None or (time_has_passed and not read(obj).equals(target.polygons)):
                outcome.refuse(target.name, "it was changed while it was solved; please run it again")
            elif not result.done:
                _report_all_skipped(outcome, obj, result, map_options)
            else:
                _write_object(outcome, obj, target.polygons, result, map_options, write_options)
                outcome.notes += [target.note] if target.note else []
        if outcome.done:
            report.store_text(outcome.entries)
    return outcome


def _sentence(error):
    return " ".join(str(error).split()) or type(error).__name__


def _problems(obj, solved):
    """What was not done, or not as it was chosen."""
    count = len(solved.components)
    for index, component in enumerate(solved.components, 1):
        part = "" if count == 1 else f"part {index} of {count} "
        if component.structure is None:
            yield f"{obj.name}: {part}skipped: {_sentence(component.reason)}"
        if component.note:
            yield f"{obj.name}: {part}made without your choice: {_sentence(component.note)}"


def _modifier_notes(obj, solved):
    closing = [m.name for m in obj.modifiers if m.type in CLOSING_MODIFIERS and not compatibility.is_auto_smooth(m)]
    if closing and any(c.surface.boundary_count for c in solved.components):
        yield f"{obj.name}: modifiers are not looked at: apply {closing[0]!r} if it closes the surface"


def _report_all_skipped(outcome, obj, solved, options):
    outcome.problems += _problems(obj, solved)
    outcome.entries.append(report.object_report(obj, solved, [], 0, options))


def _write_object(outcome, obj, polygons, solved, map_options, options):
    mesh = obj.data
    mesh_io.remove_maps(mesh)
    written = [mesh_io.write_map(mesh, polygons, name, uv) for name, uv in maps.map_values(solved, map_options)]
    shown = written[min(options.shown, len(written) - 1)]
    mesh_io.show_map(mesh, shown.name)
    new_seams = mesh_io.add_seams(mesh, _seam_pairs(solved)) if options.seams else 0
    shape = maps.shape_points(solved) if options.shape else None
    if shape is not None:
        mesh_io.write_shape(mesh, shape)
    if options.checker:
        _show_checker(outcome, obj, solved, shown, map_options, options)
    mesh.update()
    entry = report.object_report(obj, solved, written, new_seams, map_options)
    report.store_on_object(obj, entry)
    outcome.entries.append(entry)
    outcome.done.append(obj.name)
    outcome.forms = max(outcome.forms, solved.form_count)
    outcome.problems += _problems(obj, solved)
    outcome.notes += _modifier_notes(obj, solved)
    extra = sum(w.kind == "attribute" for w in written)
    if extra:
        maps_are = "1 map is a corner attribute" if extra == 1 else f"{extra} maps are corner attributes"
        outcome.notes.append(f"{obj.name}: {maps_are}, for want of UV map slots")


def _show_checker(outcome, obj, solved, shown, map_options, options):
    if not outcome.squares:  # all objects of a run share the material
        outcome.squares = options.checker_scale or maps.squares_that_fit(solved, map_options)
    is_attribute = shown.kind == "attribute"
    material.show_checker(obj, material.checker_material(shown.name, is_attribute, outcome.squares))


def _seam_pairs(solved):
    """(#S,2) vertices of the object: where the maps are cut."""
    return np.concatenate([c.structure.edges[c.structure.seams] for c in solved.done])
