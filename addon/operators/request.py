# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked for by dials: of an operator or an object; and its run."""

import ast
import math
from dataclasses import replace
from functools import partial

import numpy as np

from .. import native
from ..maps import mapped
from ..maps.mapped import BALANCED, ISLANDS, SEAMLESS, Arrangement, MappedObject, Request
from ..materials import material, textures, user_texture
from ..materials.user_texture import AUTOMATIC, IMAGE, MATERIAL
from ..native import holomorph
from ..results import report, symmetric, write
from ..results.write import WriteOptions
from ..scene import mesh_io, stored_dials, targets
from ..solving import jobs

FACES = {"AUTOMATIC": jobs.SELECTED, "FACES": jobs.ASKED}  # by the use of the selection
AXES = "XYZ"
MOST_SHARP = 0.5  # part of the edges: marks of more do not tell where islands end
ALLOWING = 0.5  # weight of a vertex above which a pole may be there
OF_SIZE = "main", "tiles", "size", "repeats", "equal"  # dials that decide how large tiles are
SQUARES = 4  # of the checker, across an image
TURNS = {"NONE": 1, "HALF": 2, "QUARTER": 4, "SIXTH": 6}  # others: those of the texture
ROWS = {
    "AUTOMATIC": "automatic",
    "ANYWHERE": "none",
    "ALONG_EDGES": "free",
    "END_AT_EDGES": "whole",
    "MIRRORED": "mirror",
}
NO_ROWS = dict.fromkeys(
    ("free", "whole"), "rows do not lie at its edges: there are none, or tiles are too large for them"
) | {"mirror": "left and right differ: none of its edges divide it into mirrored halves in X or Y"}
LINED = (2, 4)  # turns of maps whose rows may do so
TURNED = {2: ("square", "half"), 4: ("square", "quarter"), 6: ("hex", "sixth")}  # lattice that they leave, their name
# Lattices that quarter turns of a map that is made leave as they are, and so the texture whole. On others it is turned
# before its jumps are rounded.
QUARTERED = ("square", ((1.0, 0.0), (0.0, 1.0)))


class Run:
    """What dials ask for of these `targets.Target`s: a request, the solves, the maps, writing, the report.
    @throws ValueError there is nothing of what is asked for on one of them

    dials : an operator, or the dials that an object stores
    own : the `user_texture.Own` that is their texture, None for one of ours
    is_trial : whether maps that cost an eye no less than those of before are not written
    goes_on : whether tiles keep the size that they have on several objects
    """

    def __init__(self, dials, found, own=None, is_trial=False, goes_on=False):
        self.tasks, self._found, self._is_equal = targets.tasks(found), found, dials.equal
        self._is_trial = is_trial
        own = own and symmetric.as_before(own, self.objects)
        self._wanted = [_wanted(dials, target, own) for target in found if not target.refused]
        self._write_options = _write_options(dials, own, len(self.tasks) if self._is_equal else 1)
        if goes_on:
            self._go_on()
        turns = {one.request.turns for one in self._wanted}
        self._notes = [_why_seams(self._write_options.texture, own, k) for k in turns]

    def _go_on(self):
        """Lets the tiles of an object have the size that they had together with those of others, if no dial says
        another."""
        (target,), stored_now = self._found, self._write_options.stored
        made = stored_dials.made(target.find())
        is_same = made and self._wanted and all(getattr(made.dials, name) == stored_now[name] for name in OF_SIZE)
        if is_same and made.together > 1:
            (wanted,) = self._wanted
            self._wanted = [replace(wanted, request=replace(wanted.request, size=ast.literal_eval(made.size)))]
            self._write_options = replace(self._write_options, together=made.together)

    def job(self, progress=None):
        """The `jobs.Job` that solves and maps."""
        return jobs.Job(self.tasks, progress, partial(mapped.follow, self._wanted, self._is_equal))

    @property
    def only(self):
        """(`mapped.MappedObject` that is wanted, `write.WriteOptions`) of a run of one object."""
        (wanted,) = self._wanted
        return wanted, self._write_options

    @property
    def objects(self):
        """The objects that may be written to."""
        return targets.objects(self._found)

    def write(self, step, job, time_has_passed=False):
        """Writes the results of the job, in a `transaction.Step` of the objects. Returns the `write.Outcome`."""
        results = targets.align(self._found, job.results)
        if self._is_trial:
            results = list(map(_tried, self._found, results))
        outcome = write.write(step, self._found, results, self._write_options, time_has_passed)
        outcome.notes += filter(None, [*self._notes, *_why_no_rows(self._found, results)] if outcome.done else [])
        return outcome


def _tried(target, made):
    """What was `mapped` for a `targets.Target` as a panel advises; a refusal where its map costs an eye no less than
    that of before. It is tried when it is asked for, since it takes as long as another map."""
    obj = target.find()
    before = stored_dials.made(obj)
    if not before or not isinstance(made, MappedObject) or not made.done or report.is_edited(obj):
        return made
    after = report.object_report(obj, made)
    if np.float32(report.cost(after)) < before.cost:  # in the precision of properties
        return made
    return holomorph.Error(f"it would be no better: {after['verdict']['sentence']}; the map stays as it is")


def collect(objects, dials):
    """The `targets.Target`s of objects, with what is chosen on them. @throws ValueError residues that are not numbers,
    or there are none of the faces that are asked for"""
    use = "NONE" if dials.main == SEAMLESS else getattr(dials, "use_selection", "NONE")
    are_islands = dials.main == ISLANDS
    is_taken = not are_islands and (dials.poles == "SELECTED" or dials.direction == "EDGES")
    faces = jobs.SELECTED if dials.main == SEAMLESS else FACES.get(use, jobs.WHOLE)
    asked = jobs.Choices(
        use=jobs.NONE if use == "FACES" or is_taken else use,
        residues=residues(getattr(dials, "residues", "")),
        is_late=are_islands,
        solver=dials.solver,
    )
    at_seams = dials.main != SEAMLESS and (dials.cut_at_seams or are_islands)
    return targets.collect(objects, asked, jobs.WHOLE if is_taken else faces, dials.modifiers, at_seams)


def residues(text):
    """The complex numbers in a text like "1 1 -2" or "1+0.5j, -1-0.5j". @throws ValueError naming what is none"""
    result = []
    for word in text.replace(",", " ").split():
        try:
            number = complex(word)
        except ValueError:
            number = complex("nan")
        if not np.isfinite(number):
            raise ValueError(f"residues: {word!r} is not a number")
        result.append(number)
    return tuple(result)


def own_texture(dials):
    """(The `user_texture.Own` that is chosen, or None; why there is none, though one was asked for)."""
    try:
        return user_texture.chosen(dials), ""
    except ValueError as error:
        return None, native.sentence(error)


def _wanted(dials, target, own):
    """The `mapped.MappedObject` that is wanted for a `targets.Target` with its selection."""
    if dials.main in (BALANCED, ISLANDS):
        request = Request(dials.main.lower(), density=_density(dials.size, 1), evenness=dials.evenness)
        request, quarters = replace(request, **_cuts(dials, target)) if dials.main == ISLANDS else request, 0
    else:
        request, quarters = _tiling(dials, target, own)
    arrangement = Arrangement(dials.density, dials.rotation, dials.margin, quarters=quarters)
    wanted = MappedObject(request, arrangement, dials.main, 0 if dials.main == SEAMLESS else dials.forms)
    return wanted if dials.main in (BALANCED, ISLANDS) else _turned(dials, target, own, wanted)


def _cuts(dials, target):
    """The fields of a `Request` that say where islands are cut. Edges that are marked sharp are hard, but where most
    are, as in files of faces with flat shading."""
    seams, degrees = target.chosen.seams, math.degrees(dials.hard_edges)
    are_few = MOST_SHARP * len(target.polygons.corner_vertices) > 2 * len(target.sharp)  # an edge has two corners
    seams = np.concatenate([seams, target.sharp]) if degrees and are_few else seams
    return {
        "seams": seams,
        "hard_edges": degrees,
        "most_stretch": dials.most_stretch if dials.most_stretch > 1 else 0.0,
    }


def _tiling(dials, target, own):
    """The `holomorph.tiling.request.Request` for a map that does not turn; its turns by 90 degrees after it is made."""
    obj = target.find()
    if target.makes_object and _are_on_the_mesh(dials):
        raise ValueError(f"{obj.name}: select poles and edges on the mesh itself, not on the result of its modifiers")
    lattice = "square" if dials.lattice == AUTOMATIC else dials.lattice
    lattice = lattice if own is None else own.lattice
    quarters = dials.quarters if lattice in QUARTERED else 0
    request = Request(
        dials.main.lower() if dials.density == 1 or dials.main == SEAMLESS else "balanced",
        tiles=None if dials.size else dials.tiles or None,
        density=_density(dials.size, dials.repeats),
        poles=_poles(dials, obj),
        lattice=lattice,
        direction=_direction(dials, obj),
        boundary=dials.boundary,
        turn=(dials.quarters - quarters) * math.pi / 2 + dials.rotation or None,
        allowed=allowed(dials.pole_group, obj),
        evenness=dials.evenness,
    )
    return request, quarters


def moved_points(dials, target):
    """The `stored_dials.Points` of an object that count, or None."""
    return None if target.makes_object else stored_dials.points_of(target.find(), dials)


def _turned(dials, target, own, wanted):
    """The same with the points that were moved, and with the turns that are asked for; of the texture, where nothing is
    chosen that they exclude. @throws ValueError something is"""
    texture = material.CHECKER if dials.texture in (IMAGE, MATERIAL) and own is None else dials.texture
    turns = TURNS.get(dials.turns) or (material.turns(texture, own) if dials.checker else 1)
    moved, is_open, request = moved_points(dials, target), dials.turns not in TURNS, wanted.request
    shifted = moved.on(wanted, 1, is_open) if moved else wanted
    if turns == 1:
        return shifted
    lattice, name = TURNED[turns]
    excluded = {
        "Points": dials.poles != "AUTOMATIC" or request.allowed is not None,
        "Pattern": dials.lattice not in (AUTOMATIC, lattice),
        "Rotation": request.turn is not None,
        "Borders": request.boundary == "straight",
    }
    chosen = [dial for dial, is_chosen in excluded.items() if is_chosen]
    if not chosen:
        turned = replace(wanted, request=replace(request, turns=turns, lattice=lattice, boundary="automatic"))
        turned = moved.on(turned, turns, is_open) if moved else turned
        rows = {} if turned.request.cones else lines(ROWS[dials.rows], target, turns)
        return replace(turned, request=replace(turned.request, **rows))
    if is_open:
        return shifted
    raise ValueError(
        f"a map with {name} turns has no choice of {' and '.join(chosen)}: leave it automatic, or set Turns to None"
    )


def lines(asked, target, turns):
    """The fields of a `Request` that say where rows end: at hard edges, and at those that are marked sharp."""
    if turns not in LINED:
        return {"lines": "automatic"}
    is_marked = asked != "none" and len(target.sharp)
    return {"lines": asked, "marked": target.sharp if is_marked else None}


def _why_seams(texture, own, turns):
    """What is told where a texture does not allow the turns of its map, or ""."""
    if material.turns(texture, own) % turns == 0:
        return ""
    name = own.name if own else textures.label(texture)
    return f"{name} looks different after a {TURNED[turns][1]} turn: seams show where the map turns"


def _why_no_rows(found, results):
    """What is told of objects whose rows do not lie at edges, as was asked."""
    for target, made in zip(found, results):
        asked = made.request.lines if isinstance(made, MappedObject) else "none"
        tilings = [part.tiling for part in made.tiled if part.tiling] if asked not in ("automatic", "none") else []
        if any(tiling.turns != 1 and tiling.lines == "none" for tiling in tilings):
            yield f"{target.name}: {NO_ROWS[asked]}"


def _density(size, repeats):
    """The UV area over the area of the surface, for images of the texture of a width, of which `repeats` lie side by
    side in a UV unit; None where no size is asked for."""
    return 1 / (size * repeats) ** 2 if size else None


def _write_options(dials, own, together):
    texture = dials.texture
    if texture in (IMAGE, MATERIAL) and own is None:  # which is not yet chosen
        texture = material.CHECKER
    shared = {"seams": dials.seams, "size": dials.size, "own": own, "together": together}
    shared["stored"] = stored_dials.read(dials)
    if dials.main != SEAMLESS:
        shared |= {"repeats": dials.repeats, "shape": dials.shape}
        return WriteOptions(dials.shown, dials.checker, texture, dials.checker_scale, **shared)
    cells = dials.repeats * (SQUARES if texture == material.CHECKER else material.cells(texture))
    return WriteOptions(0, dials.checker, texture, cells, empties=dials.empties, **shared)


def _are_on_the_mesh(dials):
    return dials.poles == "SELECTED" or dials.direction == "EDGES" or bool(dials.pole_group)


def _poles(dials, obj):
    if dials.poles == "COUNT":
        return dials.pole_count
    if dials.poles == "AUTOMATIC":
        return "auto"
    if dials.poles == "COARSE":
        return _poles_where_coarse(obj)
    selected = tuple(sorted(mesh_io.selected_vertices(obj.data).tolist()))
    if not selected:
        raise ValueError(f"{obj.name}: select the vertices to use as poles")
    return selected


def _poles_where_coarse(obj):
    """The poles of the last tiling, and the coarsest vertices of the places that were found."""
    vertices, kinds = report.points(obj, whole=True)
    if report.POLE not in kinds:
        return "auto"
    poles = {*vertices[kinds == report.POLE].tolist(), *map(int, stored_dials.made(obj).coarse_vertices.split())}
    return tuple(sorted(vertex for vertex in poles if vertex < len(obj.data.vertices)))


def allowed(name, obj):
    """Where poles may be: where the group's weight is above `ALLOWING`; None for anywhere."""
    if not name:
        return None
    group = obj.vertex_groups.get(name)
    if group is None:
        raise ValueError(f"{obj.name}: there is no vertex group {name!r}")
    mask = mesh_io.weights(obj.data, group.index) > ALLOWING
    if not mask.any():
        raise ValueError(f"{obj.name}: no vertex has a weight above {ALLOWING} in {name!r}")
    return mask


def _direction(dials, obj):
    """The direction of a `Request`, in the frame of the polygons: as the object stands in space, without its
    translation."""
    if dials.direction in ("NONE", "UPRIGHT"):
        return None if dials.direction == "NONE" else "upright"
    linear = mesh_io.linear(obj)
    if dials.direction in AXES:
        axis = linear[:, AXES.index(dials.direction)]
        if not _has_length(axis):
            raise ValueError(f"{obj.name}: its {dials.direction} axis is scaled to 0: choose another direction")
        return tuple(axis.tolist())
    edges = mesh_io.edge_vectors(obj.data, mesh_io.marked_edges(obj.data, "select")) @ linear.T
    if not _has_length(edges):
        raise ValueError(f"{obj.name}: select the edges for the rows to follow")
    return mean_direction(edges)


def _has_length(vectors):
    return vectors.any() and np.isfinite(vectors).all()


def mean_direction(vectors):
    """The line that (n, 3) vectors lie along most, whichever way each points: the first axis of their moments; its
    largest coordinate is positive."""
    vectors = vectors / np.abs(vectors).max()
    _, axes = np.linalg.eigh(vectors.T @ vectors)
    axis = axes[:, -1]
    return tuple((axis * np.sign(axis[np.argmax(np.abs(axis))])).tolist())
