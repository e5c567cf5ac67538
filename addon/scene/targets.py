# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a run, as they are when it begins: their polygons, and what is chosen on them."""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from .. import compatibility
from ..solving import choices, solve
from . import evaluated, faces, mesh_edges, mesh_io

SAME_SCALE = 1e-5  # relative: matrices of objects are float32
NO_EDGES = np.empty((0, 2), np.int64)
MOST_PICKED = 64  # vertices; a larger selection is no choice of single vertices


@dataclass(frozen=True)
class Target:
    """An object to treat; it is found again by name, since Python's references do not survive everything."""

    name: str
    library: str | None
    polygons: mesh_io.Polygons | None
    chosen: choices.Choices = choices.Choices()
    refused: str = ""
    note: str = ""
    mask: np.ndarray | None = None  # (#F,) which faces of the mesh are mapped, None for all
    modifiers: bool = False  # whether the polygons are those that the modifiers make
    makes_object: bool = False  # whether these become an object of their own

    def find(self):
        return bpy.data.objects.get((self.name, self.library))

    def has_changed(self, time_has_passed):
        """Whether the object is gone or, where Blender was alive meanwhile, its mesh is not what was read."""
        obj = self.find()
        return obj is None or (time_has_passed and not self._is_what_was_read(obj))

    def _is_what_was_read(self, obj):
        if self.modifiers:
            return evaluated.read(obj, _linear(obj))[0].equals(self.polygons)
        has_faces = self.mask is None or len(obj.data.polygons) == len(self.mask)
        return has_faces and read(obj, self.mask).equals(self.polygons)


@dataclass(frozen=True)
class Request:
    """What is asked of every object of a run; the choices on each mesh are made of it."""

    use: str = choices.NONE  # what the selected vertices are
    vertices: tuple | None = None  # instead of the selected ones
    residues: tuple = ()
    cut_at_seams: bool = False
    boundary: str = "natural"
    solver: str = "auto"
    faces: str = faces.WHOLE  # which ones are mapped
    modifiers: bool = False  # whether they count, in object mode
    hard_edges: float = 0.0  # degrees: islands are cut along sharper edges and those marked sharp; 0 for seams alone
    most_stretch: float = 0.0  # islands are cut open where lengths change by a larger factor; 0 for no such cuts

    @property
    def how(self):
        """The last fields of the `choices.Choices`."""
        return self.boundary, self.solver, self.hard_edges, self.most_stretch


def use_of_vertices(selection):
    """What selected vertices are for a use of the selection."""
    return choices.NONE if selection == choices.FACES else selection


def use_of_faces(selection):
    """Which faces are mapped for a use of the selection, one of those in `faces`."""
    return {choices.AUTOMATIC: faces.SELECTED, choices.FACES: faces.ASKED}.get(selection, faces.WHOLE)


def mesh_objects(context):
    """The mesh objects the operator is about, the active one first."""
    if context.mode == "EDIT_MESH":
        objects = compatibility.objects_being_edited(context)
    else:
        objects = [o for o in compatibility.selected_objects(context) if o.type == "MESH"]
    active = context.view_layer.objects.active
    return sorted(objects, key=lambda o: o != active)


def collect(objects, request=Request()):
    """Reads the polygons and the choices of every object; of those that share a mesh, the first one counts.
    @throws `faces.NoFaces`"""
    targets, first = [], {}
    for obj in objects:
        if obj.mode == "EDIT":
            obj.update_from_editmode()
    masks = faces.masks(objects, request.faces)
    for obj in objects:
        mesh = obj.data
        if mesh not in masks:
            continue
        target = _target(obj, masks[mesh], request) if mesh not in first or request.modifiers else None
        if target is None or (mesh in first and not target.makes_object):
            index, other = first[mesh]
            if not np.allclose(_metric(obj), _metric(other), rtol=0, atol=SAME_SCALE):
                note = f"{obj.name} has the same mesh in another scale; the scale of {other.name} counts"
                targets[index] = replace(targets[index], note=note)
            continue
        if not target.makes_object:
            first[mesh] = len(targets), obj
        targets.append(target)
    return targets


def _target(obj, mask, request):
    library = obj.library.filepath if obj.library else None
    target = Target(obj.name, library, None, mask=mask)
    if obj.data.library is not None:
        return replace(target, refused="its mesh is linked from another file; make it local first")
    if request.boundary == choices.ISLANDS and request.use in choices.EXPLICIT:
        return replace(target, refused="islands have no punctures or corners: choose those or another main map")
    own = read(obj, mask)
    if request.modifiers and obj.mode != "EDIT":
        return _with_modifiers(obj, replace(target, modifiers=True), own, request)
    if not own.face_count and evaluated.first_of(obj) and evaluated.read(obj, _linear(obj))[0].face_count:
        sentence = f"all its faces come from its modifiers ({evaluated.first_of(obj)}): press Map with Modifiers"
        return replace(target, refused=sentence)
    return replace(target, polygons=own, chosen=_choices(obj, request))


def _with_modifiers(obj, target, own, request):
    """The target where the modifiers count: their polygons, for the object's own mesh if these are its own."""
    shown, seams = evaluated.read(obj, _linear(obj))
    if target.mask is None and evaluated.are_those_of(shown, own):
        return replace(target, polygons=replace(own, vertices=shown.vertices), chosen=_choices(obj, request))
    if not shown.face_count:
        return replace(target, refused=f"its modifiers leave no faces; the first is {evaluated.first_of(obj)}")
    if target.mask is not None or request.use in choices.EXPLICIT:
        return replace(target, refused="the selection is one of the mesh itself, not of what its modifiers make")
    seams = seams if request.cut_at_seams else NO_EDGES
    chosen = choices.Choices(choices.NONE, (), (), seams, *request.how)
    note = "what its modifiers make is an object now; the object itself is hidden"
    return replace(target, polygons=shown, chosen=chosen, makes_object=True, note=f"{obj.name}: {note}")


def _choices(obj, request):
    """What was chosen on this object; @pre pending edits are written to the mesh."""
    marks = (["use_seam"] if request.cut_at_seams else []) + (["use_edge_sharp"] if request.hard_edges else [])
    seams = np.concatenate([NO_EDGES, *(mesh_edges.marked_edges(obj.data, mark) for mark in marks)])
    selected = request.vertices if request.vertices is not None else _selected(obj, request.use)
    return choices.Choices(request.use, tuple(selected), request.residues, seams, *request.how)


def _selected(obj, use):
    """The selected vertices. Automatic use takes single vertices in edit mode, not faces or edges that are selected."""
    if use == choices.NONE or (use == choices.AUTOMATIC and obj.mode != "EDIT"):
        return ()
    selected = mesh_io.selected_vertices(obj.data)
    if use == choices.AUTOMATIC and (len(selected) > MOST_PICKED or mesh_edges.are_neighbours(obj.data, selected)):
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
    """The same target with these (#V,3) float64 positions: those of a file are more precise than Blender's."""
    return replace(target, polygons=replace(target.polygons, vertices=vertices))


def tasks(targets):
    return [solve.Task(t.polygons, t.chosen) for t in targets if not t.refused]


def align(targets, results):
    """The results in the order of all targets; a target that was refused at once has none."""
    solved = iter(results)
    return [None if t.refused else next(solved) for t in targets]


def read(obj, mask=None):
    """The polygons as they are seen: with the object's scale, without modifiers; some of them for a mask."""
    return faces.part(mesh_io.read_polygons(obj.data, _linear(obj)), mask)
