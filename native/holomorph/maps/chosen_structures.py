"""The structures of the parts of a mesh, by what is chosen on the mesh: vertices, seams, a method.

Where an explicit choice does not fit a part, the mesh is refused. A choice that is only found there, a selection that
nothing is said of, or seams, is left out with a note.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._native import InvalidMesh, SolverError, TopologyError
from ..core.array_types import Integers, Progress
from ..core.progress import scaled
from ..mesh.edges import boundary_edges, edge_keys, polygon_sides
from ..mesh.surface import Surface
from .automatic_structure import AnyStructure, LateStructure, automatic_structure, late_structure

AUTOMATIC, POLES, RECTANGLE, NONE = "AUTOMATIC", "POLES", "RECTANGLE", "NONE"  # what chosen vertices are
CORNERS = 4
NO_EDGES = np.empty((0, 2), np.int64)
UV_START = 0.6  # fraction of the work after which the potentials of the maps are solved for


@dataclass(frozen=True)
class Choices:
    """What is chosen on a mesh, in vertices of the mesh as given.

    use : what the vertices are: poles, corners of a rectangle, or what suits each part
    vertices : in the order in which they were chosen
    residues : one for each pole; none lets them be chosen
    seams : (#S, 2) vertices
    is_late : structures are made when they are asked for: islands need none
    """

    use: str = NONE
    vertices: tuple[int, ...] | None = None
    residues: tuple[complex, ...] = ()
    seams: Integers = field(default_factory=NO_EDGES.copy, compare=False)
    solver: str = "auto"
    is_late: bool = False

    @property
    def key(self) -> tuple[Any, ...]:
        """Equal for choices that give the same structures."""
        chosen = (self.use, self.vertices, self.residues) if self.vertices else ()
        return (*chosen, self.seams.tobytes(), self.solver, self.is_late)

    @property
    def is_explicit(self) -> bool:
        return self.use in (POLES, RECTANGLE)


@dataclass(frozen=True)
class PartStructure:
    """A connected part of a mesh.

    structure : with the vertices as the whole mesh counts them, and the corners as the part does; None where it was
        refused
    reason : why it was refused; note : which choice was not followed, and why
    is_chosen : whether a choice was followed of how the map is made, and not just how fast
    """

    surface: Surface
    structure: AnyStructure | None
    reason: str = ""
    note: str = ""
    is_chosen: bool = False


def chosen_structures(
    vertices: ArrayLike,
    corner_vertices: ArrayLike,
    face_offsets: ArrayLike,
    choices: Choices = Choices(),
    progress: Progress | None = None,
) -> tuple[Surface, list[PartStructure]]:
    """(the surface of these polygons, its parts). Raises for a mesh that cannot be treated as a whole, and where an
    explicit choice of vertices does not fit the part they lie on."""
    surface = Surface.from_polygons(vertices, corner_vertices, face_offsets, strict=False)
    explicit = np.array(choices.vertices if choices.is_explicit else (), np.int64)
    stray = explicit[~np.isin(explicit, corner_vertices)]
    if len(stray):
        raise InvalidMesh(f"vertex {stray[0]} belongs to no face and cannot be chosen")
    chosen, parts = _on_surface(choices, surface), surface.components
    sizes, done, made = [len(part.face_index) for part in parts], 0.0, []
    for part, size in zip(parts, sizes):
        share = size / max(sum(sizes), 1)
        made.append(_structure_of_part(part, surface, vertices, chosen, scaled(progress, done, done + share)))
        done += share
    return surface, made


def _on_surface(choices, surface):
    """The same choices where vertices of the mesh were joined: the lowest of them stands for all."""
    lowest = surface._origin.lowest
    vertices = choices.vertices and tuple(dict.fromkeys(lowest(np.array(choices.vertices, np.int64)).tolist()))
    return replace(choices, vertices=vertices, seams=lowest(choices.seams))


def _structure_of_part(part, surface, vertices, choices, progress):
    """The `PartStructure` of the most that can be followed of the choices."""
    if choices.is_late:
        return PartStructure(part, LateStructure(surface, part))
    note, (*earlier, last) = "", wanted(part, choices)
    for keywords in earlier:
        try:
            return _made(part, surface, vertices, keywords, note, progress)
        except (InvalidMesh, TopologyError) as error:
            note = note or str(error)
    try:
        return _made(part, surface, vertices, last, note, progress)
    except (InvalidMesh, TopologyError, SolverError) as error:
        if choices.is_explicit and _has_selection(last):
            raise
        return PartStructure(part, None, reason=str(error), note=note)


def wanted(part: Surface, choices: Choices) -> list[dict[str, Any]]:
    """Keywords of `automatic_structure` for a part, the most wanted first; the later ones leave out what is not
    explicit. Vertices are those of the mesh as given."""
    base = {"solver": choices.solver}
    seams = choices.seams
    if len(seams):
        seams = seams[np.isin(seams, part.vertex_index).all(axis=1)]
    found = [base | {"cuts": seams}, base] if len(seams) else [base]
    selection = _selection(part, choices)
    if selection:
        selected = [keywords | selection for keywords in found]
        found = selected if choices.is_explicit else selected + found
    return [_with_fitting_solver(part, keywords) for keywords in found]


def _with_fitting_solver(part, keywords):
    """The paper's solver is for parts that have forms: other parts of a mesh are solved as usual."""
    if keywords["solver"] != "paper":
        return keywords
    has_forms = 2 * part.genus + part.boundary_count - (part.boundary_count > 0) > 0
    return keywords if has_forms and not _has_selection(keywords) else keywords | {"solver": "auto"}


def _has_selection(keywords: Mapping[str, Any]) -> bool:
    return not keywords.keys().isdisjoint({"poles", "corners"})


def _selection(part, choices):
    """The selected vertices of this part as poles or corners; nothing where there are none."""
    if choices.use == NONE or not choices.vertices:
        return {}
    selected = np.asarray(choices.vertices, np.int64)
    is_own = np.isin(selected, part.vertex_index)
    own = selected[is_own]
    if len(own) == 0:
        return {}
    if choices.use == RECTANGLE or (choices.use == AUTOMATIC and _are_corners_of_a_disk(part, own)):
        return {"corners": own}
    if not choices.residues:
        return {"poles": own}
    residues = np.asarray(choices.residues, complex)
    # `log_map` refuses a wrong number of residues.
    return {"poles": own, "residues": residues[is_own] if len(residues) == len(is_own) else residues}


def _are_corners_of_a_disk(part, vertices):
    if (part.genus, part.boundary_count) != (0, 1) or len(vertices) != CORNERS:
        return False
    return bool(np.isin(vertices, part.vertex_index[boundary_edges(part)]).all())


def _made(part, surface, vertices, keywords, note, progress):
    target, names_vertices = part, _has_selection(keywords) or "cuts" in keywords
    if names_vertices and (np.diff(part.vertex_index) == 0).any():  # it was cut: vertices are several on the part
        keywords = _in_part(keywords, part)
    elif names_vertices:  # the part's faces with all vertices of the mesh: then its indices are theirs
        target = Surface.from_polygons(vertices, part.vertex_index[part.corner_vertices], part.face_offsets)
    if keywords == {"solver": "auto"} and (late := late_structure(part)):
        return PartStructure(part, replace(late, surface=surface), note=note)
    structure = automatic_structure(target, **keywords, progress=scaled(progress, 0.0, UV_START))
    structure.prepare_uv(scaled(progress, UV_START, 1.0))
    structure = replace(structure, surface=surface)  # so do its results
    units = np.eye(structure.form_count, dtype=structure.coefficient_type)
    structure.uv(units[0] if len(units) else ())  # refused here, where it is not finite
    is_chosen = names_vertices or keywords["solver"] == "paper"
    return PartStructure(part, structure, note=note, is_chosen=is_chosen)


def _in_part(keywords, part):
    """Keywords of vertices of the whole mesh as those of the part: the first copy of each, all copies of an edge."""
    own = {
        name: np.searchsorted(part.vertex_index, keywords[name]) for name in ("poles", "corners") if name in keywords
    }
    if "cuts" in keywords:
        sides, count = polygon_sides(part), part.given_vertex_count
        keys, cut = (edge_keys(ends, count) for ends in (part.vertex_index[sides], keywords["cuts"]))
        own["cuts"] = sides[np.isin(keys, cut)]
    return keywords | own
