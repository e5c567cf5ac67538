# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked for by the properties of an operator, or by the headless command under the same names, and its run."""

import math
from dataclasses import replace

import numpy as np

from ..maps import mapped
from ..maps.mapped import TILING, MapOptions, TileOptions
from ..materials import material, textures
from ..materials.user_texture import AUTOMATIC, IMAGE, MATERIAL
from ..results import advice, report, stored, symmetric, write
from ..results.write import WriteOptions
from ..scene import gathering, mesh_io, targets
from ..solving import jobs
from ..solving.jobs import Choices

FACES = {"AUTOMATIC": jobs.SELECTED, "FACES": jobs.ASKED}  # by the use of the selection
AXES = "XYZ"
ALLOWING = 0.5  # weight of a vertex above which a pole may be there
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
QUICK_TURNED = 100_000  # triangles of an object: some 12 seconds, which grow as their square
# Lattices that quarter turns of a map that is made leave as they are, and so the texture whole. On others it is turned
# before its jumps are rounded.
QUARTERED = ("square", ((1.0, 0.0), (0.0, 1.0)))


class Run:
    """What properties ask for of these `targets.Target`s: a request, the solves, the maps, writing, the report.
    @throws ValueError there is nothing of what is asked for on one of them

    own : the `user_texture.Own` that is their texture, None for one of ours
    is_trial : whether maps that cost an eye no less than those of before are not written
    """

    def __init__(self, properties, found, own=None, is_trial=False):
        self.tasks, self._found, self._is_equal = targets.tasks(found), found, properties.equal
        self._is_trial = is_trial
        own = own and symmetric.as_before(own, self.objects)
        options = _tile_options if properties.is_tiling else _map_options
        self._options = [options(properties, target, own) for target in found if not target.refused]
        self._write_options = _write_options(properties, own)
        turns = {one.tiling.turns for one in self._options}
        self._notes = [_why_seams(self._write_options.texture, own, k) for k in turns]

    def job(self, progress=None):
        """The `jobs.Job` that solves and maps."""
        return jobs.Job(self.tasks, progress, mapped.follow(self._options, self._is_equal))

    @property
    def objects(self):
        """The objects that may be written to."""
        return targets.objects(self._found)

    def write(self, step, job, time_has_passed=False):
        """Writes the results of the job, in a `transaction.Step` of the objects. Returns the `report.Outcome`."""
        results = targets.align(self._found, job.results)
        if self._is_trial:
            results = list(map(advice.tried, self._found, results))
        outcome = write.write(step, self._found, results, self._write_options, time_has_passed)
        outcome.notes += filter(None, [*self._notes, *_why_no_rows(self._found, results)] if outcome.done else [])
        return outcome


def choices(properties):
    """The `jobs.Choices`. @throws ValueError residues that are not numbers"""
    if properties.is_tiling:
        is_selection_taken = properties.poles == "SELECTED" or properties.direction == "EDGES"
        return Choices(faces=jobs.WHOLE if is_selection_taken else jobs.SELECTED, modifiers=properties.modifiers)
    are_islands, use = properties.main == "ISLANDS", properties.use_selection
    return Choices(
        use=jobs.NONE if use == "FACES" else use,
        faces=FACES.get(use, jobs.WHOLE),
        residues=jobs.numbers(properties.residues),
        cut_at_seams=properties.cut_at_seams or are_islands,
        are_islands=are_islands,
        solver=properties.solver,
        modifiers=properties.modifiers,
        hard_edges=math.degrees(properties.hard_edges) if are_islands else 0.0,
        most_stretch=properties.most_stretch if are_islands else 0.0,
    )


def _map_options(properties, target, own):
    """The `mapped.MapOptions` for a `targets.Target`."""
    lattice = {} if own is None else {"lattice": own.lattice}
    tiling = TileOptions(density=_density(properties.size, 1), evenness=properties.evenness, **lattice)
    return MapOptions(
        properties.forms,
        properties.density,
        properties.rotation,
        tuple(properties.amounts),
        tuple(properties.phases),
        properties.margin,
        properties.main,
        tiling=_turned(properties, target, own, tiling),
    )


def _tile_options(properties, target, own):
    """The `mapped.MapOptions` for a `targets.Target` with its selection."""
    obj = target.find()
    if target.makes_object and _are_on_the_mesh(properties):
        raise ValueError(f"{obj.name}: select poles and edges on the mesh itself, not on the result of its modifiers")
    lattice = "square" if properties.lattice == AUTOMATIC else properties.lattice
    lattice = lattice if own is None else own.lattice
    quarters = properties.quarters if lattice in QUARTERED else 0
    tiling = TileOptions(
        tiles=0.0 if properties.size else float(properties.tiles),
        density=_density(properties.size, properties.repeats),
        poles=_poles(properties, obj),
        lattice=lattice,
        direction=_direction(properties, obj),
        boundary=properties.boundary,
        turn=(properties.quarters - quarters) * math.pi / 2 + properties.turn,
        quarters=quarters,
        pole_group=properties.pole_group,
        allowed=allowed(properties.pole_group, obj),
        evenness=properties.evenness,
    )
    return MapOptions(forms=0, main=TILING, tiling=_turned(properties, target, own, tiling))


def _turned(properties, target, own, tiling):
    """The `TileOptions` with the turns that are asked for; of the texture, where nothing is chosen that they exclude.
    @throws ValueError something is"""
    texture = material.CHECKER if properties.texture in (IMAGE, MATERIAL) and own is None else properties.texture
    turns = TURNS.get(properties.turns) or (material.turns(texture, own) if _follows_texture(properties, target) else 1)
    if turns == 1:
        return tiling
    lattice, name = TURNED[turns]
    excluded = {
        "Poles": getattr(properties, "poles", "AUTOMATIC") != "AUTOMATIC" or tiling.allowed is not None,
        "Lattice": getattr(properties, "lattice", AUTOMATIC) not in (AUTOMATIC, lattice),
        "Rotation": tiling.turn != 0,
        "Boundary": tiling.boundary == "straight",
    }
    chosen = [dial for dial, is_chosen in excluded.items() if is_chosen]
    if not chosen:
        return replace(
            tiling, turns=turns, lattice=lattice, boundary="automatic", **lines(ROWS[properties.rows], target, turns)
        )
    if properties.turns not in TURNS:
        return tiling
    raise ValueError(
        f"a map with {name} turns has no choice of {' and '.join(chosen)}: leave it automatic, or set Turns to None"
    )


def lines(asked, target, turns):
    """The fields of `TileOptions` that say where rows end: at hard edges, and at those that are marked sharp."""
    if turns not in LINED:
        return {"lines": "automatic"}
    is_marked = asked != "none" and len(target.sharp)
    return {"lines": asked, "marked": target.sharp.astype(np.int64).tobytes() if is_marked else None}


def _follows_texture(properties, target):
    """Whether a map turns as its texture does: where it is shown, and that is quick."""
    polygons = target.polygons
    return properties.checker and len(polygons.corner_vertices) - 2 * polygons.face_count <= QUICK_TURNED


def _why_seams(texture, own, turns):
    """What is told where a texture does not allow the turns of its map, or ""."""
    if material.turns(texture, own) % turns == 0:
        return ""
    name = own.name if own else textures.label(texture)
    return f"{name} looks different after a {TURNED[turns][1]} turn: seams show where the map turns"


def _why_no_rows(found, results):
    """What is told of objects whose rows do not lie at edges, as was asked."""
    for target, made in zip(found, results):
        asked = made.options.tiling.lines if isinstance(made, mapped.MappedObject) else "none"
        tilings = [part.tiling for part in made.tiled if part.tiling] if asked not in ("automatic", "none") else []
        if any(tiling.turns != 1 and tiling.lines == "none" for tiling in tilings):
            yield f"{target.name}: {NO_ROWS[asked]}"


def _density(size, repeats):
    """The UV area over the area of the surface, for images of the texture of a width, of which `repeats` lie side by
    side in a UV unit; 0 where no size is asked for."""
    return 1 / (size * repeats) ** 2 if size else 0.0


def _write_options(properties, own):
    texture = properties.texture
    if texture in (IMAGE, MATERIAL) and own is None:  # which is not yet chosen
        texture = material.CHECKER
    shared = {"seams": properties.seams, "size": properties.size, "own": own}
    if not properties.is_tiling:
        shown = properties.shown, properties.checker, texture, properties.checker_scale
        return WriteOptions(*shown, shape=properties.shape, **shared)
    cells = properties.repeats * (SQUARES if texture == material.CHECKER else material.cells(texture))
    return WriteOptions(0, properties.checker, texture, cells, empties=properties.empties, **shared)


def _are_on_the_mesh(properties):
    return properties.poles in ("SELECTED", "KEPT") or properties.direction == "EDGES" or bool(properties.pole_group)


def _poles(properties, obj):
    if properties.poles == "COUNT":
        return properties.pole_count
    if properties.poles == "AUTOMATIC":
        return "auto"
    if properties.poles == "KEPT":
        return _kept_poles(obj)
    if properties.poles == "COARSE":
        return _poles_where_coarse(obj)
    selected = tuple(sorted(mesh_io.selected_vertices(obj.data).tolist()))
    if not selected:
        raise ValueError(f"{obj.name}: select the vertices to use as poles")
    return selected


def _kept_poles(obj):
    vertices, is_pole = stored.marks(obj.get(report.PROPERTY))
    kept = vertices[is_pole & (vertices < len(obj.data.vertices))]
    if not len(kept):
        raise ValueError(f"{obj.name}: it has no poles from an earlier tiling")
    return tuple(sorted(kept.tolist()))


def _poles_where_coarse(obj):
    """The poles of the last tiling, and the coarsest vertices of the places that its report names."""
    text = obj.get(report.PROPERTY)
    vertices, is_pole = stored.marks(text)
    if not is_pole.any():
        return "auto"
    found = [place["vertex"] for place in stored.parsed(text).get("coarse_places", [])]
    poles = {*vertices[is_pole].tolist(), *found}
    return tuple(sorted(vertex for vertex in poles if vertex < len(obj.data.vertices)))


def allowed(name, obj):
    """Where poles may be, see `mapped.TileOptions`: where the group's weight is above `ALLOWING`."""
    if not name:
        return None
    group = obj.vertex_groups.get(name)
    if group is None:
        raise ValueError(f"{obj.name}: there is no vertex group {name!r}")
    mask = mesh_io.weights(obj.data, group.index) > ALLOWING
    if not mask.any():
        raise ValueError(f"{obj.name}: no vertex has a weight above {ALLOWING} in {name!r}")
    return mask.tobytes()


def _direction(properties, obj):
    """The direction of `mapped.TileOptions`, in the frame of the polygons: as the object stands in space, without its
    translation."""
    if properties.direction in ("NONE", "UPRIGHT"):
        return None if properties.direction == "NONE" else "upright"
    linear = gathering.linear(obj)
    if properties.direction in AXES:
        axis = linear[:, AXES.index(properties.direction)]
        if not _has_length(axis):
            raise ValueError(f"{obj.name}: its {properties.direction} axis is scaled to 0: choose another direction")
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
