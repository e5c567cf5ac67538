# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a run, as they are when it begins: their polygons, and what is chosen on them."""

from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from ..compatibility import Values
from ..native import holomorph
from ..solving import jobs
from ..solving.jobs import Choices
from . import gathering, mesh_io

EVERYTHING = Choices()
MOST_PICKED = 64  # vertices; a larger selection is not a choice of single vertices


@dataclass(frozen=True)
class Target:
    """An object to treat; it is found again by name, since Python's references do not survive everything."""

    name: str
    library: str | None
    polygons: mesh_io.Polygons | None
    chosen: Choices = Choices()
    refused: str = ""
    note: str = ""
    mask: np.ndarray | None = None  # (#F,) which faces of the mesh are mapped, None for all
    modifiers: bool = False  # whether the polygons are those that the modifiers make
    makes_object: bool = False  # whether these become an object of their own
    sharp: np.ndarray = field(default_factory=jobs.NO_EDGES.copy)  # (n, 2) vertices of the edges that are marked sharp
    sharers: tuple = ()  # names of the further objects with this mesh that are asked for

    def find(self):
        return bpy.data.objects.get((self.name, self.library))

    def find_sharers(self):
        return [bpy.data.objects[name, None] for name in self.sharers]

    def has_changed(self, time_has_passed):
        """Whether the object is gone or, where Blender was alive meanwhile, its mesh is not what was read."""
        obj = self.find()
        return obj is None or (time_has_passed and not self._is_what_was_read(obj))

    def _is_what_was_read(self, obj):
        if self.modifiers:
            return mesh_io.read_shown(obj, self.polygons)[0].equals(self.polygons)
        has_faces = self.mask is None or len(obj.data.polygons) == len(self.mask)
        return has_faces and mesh_io.read(obj, self.mask).equals(self.polygons)


def collect(objects, asked=EVERYTHING, faces=jobs.WHOLE, modifiers=False, at_seams=False):
    """Reads the polygons and the choices of every object; of those that share a mesh, the first one counts.
    @throws ValueError there are none of the faces that are asked for

    asked : what is chosen on each of them, without its vertices and edges
    faces : which ones are mapped; modifiers : whether they count, in object mode
    at_seams : whether the marked seams are those of the choices
    """
    _write_pending_edits(objects)
    masks = _masks(objects, faces)
    targets, first = {}, {}  # by object; the object that counts by mesh
    for obj in [o for o in objects if o.data in masks]:
        other = first.get(obj.data)
        target = _target(obj, masks[obj.data], asked, modifiers, at_seams) if other is None or modifiers else None
        if target is None or (other is not None and not target.makes_object):
            targets[other] = replace(targets[other], sharers=(*targets[other].sharers, obj.name))
            continue
        targets[obj] = target
        if not target.makes_object:
            targets[obj], first[obj.data] = replace(target, note=_scale_note(obj)), obj
    return list(targets.values())


def _write_pending_edits(objects):
    for obj in objects:
        if obj.mode == "EDIT":
            obj.update_from_editmode()


def _scale_note(obj):
    """The note for a mesh that further objects have in another scale."""
    names = [other.name for other in gathering.others(obj) if gathering.has_other_scale(obj, other)]
    if not names:
        return ""
    which = f"{names[0]} has" if len(names) == 1 else f"{names[0]} and {len(names) - 1} more have"
    return f"{which} the same mesh in another scale; the scale of {obj.name} is used"


def _masks(objects, wanted):
    """{mesh: (#F,) bool, or None for all faces}; meshes of which nothing is selected are left out where something is
    selected on others. @pre pending edits are written to the meshes. @throws ValueError as `collect`"""
    meshes = list(dict.fromkeys(obj.data for obj in objects))
    selected = {} if wanted == jobs.WHOLE else _selected_faces(meshes, wanted == jobs.ASKED)
    if selected:
        return {mesh: _or_all(flags) for mesh, flags in selected.items()}
    if wanted == jobs.ASKED:
        raise ValueError("select the faces to map")
    return {mesh: _or_all(~_flags(mesh, "hide")) if mesh.is_editmode else None for mesh in meshes}


def _selected_faces(meshes, in_any_mode):
    """{mesh: (#F,) bool} of those meshes of this file that have some, by default in edit mode alone."""
    own = [mesh for mesh in meshes if mesh.library is None and (mesh.is_editmode or in_any_mode)]
    found = {mesh: _flags(mesh, "select") & ~_flags(mesh, "hide") for mesh in own}
    return {mesh: flags for mesh, flags in found.items() if flags.any()}


def _or_all(mask):
    return None if mask.all() else mask


def _flags(mesh, name):
    return mesh_io.read_values(Values(mesh.polygons, name, bool))


def _target(obj, mask, asked, modifiers, at_seams):
    library = obj.library.filepath if obj.library else None
    target = Target(obj.name, library, None, mask=mask)
    reason = _why_refused(obj, mask, asked)
    if reason:
        return replace(target, refused=reason)
    own, sharp = mesh_io.read(obj, mask), mesh_io.marked_edges(obj.data, mesh_io.SHARP)
    target = replace(target, sharp=sharp)
    if modifiers and obj.mode == "OBJECT":
        return _with_modifiers(replace(target, modifiers=True), obj, own, asked, at_seams)
    modifier = "" if own.face_count else first_modifier(obj)
    if modifier and mesh_io.read_shown(obj, own)[0].face_count:
        sentence = f"all its faces come from its modifiers ({modifier}): switch With Modifiers on"
        return replace(target, refused=sentence)
    return replace(target, polygons=own, chosen=_chosen(obj, asked, at_seams))


def _why_refused(obj, mask, asked):
    """Why the object is refused, one sentence, or ""."""
    if mask is not None and not mask.any():
        return gathering.why_fixed(obj) or "all its faces are hidden"
    if asked.is_late and asked.is_explicit:
        return gathering.why_fixed(obj) or "islands have neither poles nor corners: choose another main map"
    return gathering.why_fixed(obj)


def _with_modifiers(target, obj, own, asked, at_seams):
    """The target as its modifiers make it: its own polygons in other places, or other ones."""
    shown, seams, sharp, are_own = mesh_io.read_shown(obj, own)
    if target.mask is None and are_own:
        chosen = _chosen(obj, asked, at_seams)
        return replace(target, polygons=replace(own, vertices=shown.vertices), chosen=chosen)
    cuts = seams if at_seams else jobs.NO_EDGES
    return _of_modifiers(replace(target, sharp=sharp), asked, shown, cuts, first_modifier(obj))


def _of_modifiers(target, asked, shown, seams, modifier):
    """The target where the modifiers make other faces, and so an object of their own."""
    if not shown.face_count:
        return replace(target, refused=f"its modifiers leave no faces; the first is {modifier}")
    if target.mask is not None or asked.is_explicit:
        return replace(target, refused="the selection is on the mesh itself, not on the result of its modifiers")
    chosen = replace(asked, use=jobs.NONE, seams=seams)
    note = f"{target.name}: the result of its modifiers is a new object; the original is hidden"
    return replace(target, polygons=shown, chosen=chosen, makes_object=True, note=note)


def first_modifier(obj):
    """The name of the first modifier that is shown, in quotes, or ""."""
    return next((repr(m.name) for m in obj.modifiers if m.show_viewport), "")


def _chosen(obj, asked, at_seams):
    """The choices, with the vertices and edges of this object; @pre pending edits are written to the mesh."""
    vertices = _selected(obj, asked.use) if asked.vertices is None else asked.vertices
    seams = mesh_io.marked_edges(obj.data, mesh_io.SEAM) if at_seams else jobs.NO_EDGES
    return replace(asked, vertices=vertices, seams=seams)


def _selected(obj, use):
    """The selected vertices. Automatic use takes single vertices in edit mode, not faces or edges that are selected."""
    if use == jobs.NONE or (use == jobs.AUTOMATIC and obj.mode != "EDIT"):
        return ()
    selected = mesh_io.selected_vertices(obj.data)
    if use == jobs.AUTOMATIC and (len(selected) > MOST_PICKED or mesh_io.are_neighbours(obj.data, selected)):
        return ()
    return tuple(selected.tolist())


def tasks(targets):
    return [jobs.Task(t.polygons, t.chosen) for t in targets if not t.refused]


def objects(targets):
    """The objects that may be written to."""
    found = (target.find() for target in targets if not target.refused)
    return [obj for obj in found if obj is not None]


def align(targets, results):
    """The results in the order of all targets; a target that was refused at once has none."""
    solved = iter(results)
    return [None if t.refused else next(solved) for t in targets]


def border(mesh, polygons):
    """(n, 2) vertices of the edges between these polygons and the others of the mesh."""
    if polygons.faces is None:
        return np.empty((0, 2), np.int64)
    whole, edges = mesh_io.read_polygons(mesh, np.eye(3)), holomorph.mesh.edges
    is_own = whole.has_corner_in(polygons.faces)
    sides = edges.polygon_sides(whole)
    keys = edges.edge_keys(sides, len(whole.vertices))
    return sides[is_own & np.isin(keys, keys[~is_own])]
