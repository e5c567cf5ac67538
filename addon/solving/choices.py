# SPDX-License-Identifier: GPL-3.0-or-later
"""What is chosen on a mesh (vertices, seams, method), and what it means for each connected part. No bpy here.

A choice becomes keywords of `holomorph.automatic_structure`. Where an explicit choice does not fit, the library refuses
it; an implicit one (a selection under "Automatic", seams) is dropped.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ..native import holomorph

# What the selection is.
AUTOMATIC, FACES, POLES, RECTANGLE, NONE = "AUTOMATIC", "FACES", "POLES", "RECTANGLE", "NONE"
EXPLICIT = (POLES, RECTANGLE)
# Which faces are mapped: all; in edit mode the selected ones if there are any; these, or a refusal.
WHOLE, SELECTED, ASKED = "WHOLE", "SELECTED", "ASKED"
ISLANDS = "islands"  # as a boundary: the mesh is cut along its seams into parts, each flattened by itself
CORNERS = 4
NO_EDGES = np.empty((0, 2), np.int64)


@dataclass(frozen=True)
class Choices:
    """What is asked of every object of a run, and then, with its own vertices and seams, of each. Vertices are those of
    the whole mesh."""

    use: str = NONE  # what the chosen vertices are
    vertices: tuple | None = None  # in the order in which they were selected, as far as that is known; None before
    residues: tuple = ()  # complex, one for each pole; none lets the library choose
    seams: np.ndarray = field(default_factory=lambda: NO_EDGES, compare=False)  # (#S,2) vertices
    boundary: str = "natural"
    solver: str = "auto"
    hard_edges: float = 0.0  # degrees: islands are cut along sharper edges, too; 0 for the seams alone
    most_stretch: float = 0.0  # islands are cut open where lengths change by a larger factor; 0 for no such cuts
    cut_at_seams: bool = False
    faces: str = WHOLE  # which ones are mapped
    modifiers: bool = False  # whether they count, in object mode

    @property
    def key(self):
        """Equal for choices that give the same solve."""
        chosen = (self.use, self.vertices, self.residues) if self.vertices else ()
        return (*chosen, self.seams.tobytes(), self.boundary, self.solver, self.hard_edges, self.most_stretch)

    @property
    def is_explicit(self):
        return self.use in EXPLICIT

    @property
    def are_islands(self):
        return self.boundary == ISLANDS


def attempts(part, choices):
    """Keywords for a connected part, the most wanted first; the later ones leave out implicit choices. Vertices are
    those of the whole mesh."""
    if choices.are_islands:
        free, base = (
            _with_fitting_method(part, {"solver": choices.solver, "boundary": boundary})
            for boundary in ("free", "natural")
        )
        return [free | {"boundary": "free"}, base]
    base = {"solver": choices.solver, "boundary": choices.boundary}
    selection = _selection(part, choices)
    seams = choices.seams
    if len(seams):
        seams = seams[np.isin(seams, part.vertex_index).all(axis=1)]
    cut = {"cuts": seams} if len(seams) else {}
    wanted = [base]
    if cut:
        wanted.insert(0, base | cut)
    if selection:
        with_selection = [keywords | selection for keywords in wanted]
        wanted = with_selection if choices.is_explicit else with_selection + wanted
    return [_with_fitting_method(part, keywords) for keywords in wanted]


def _with_fitting_method(part, keywords):
    """The double is for the forms of surfaces with boundary, the paper's solver for all parts that have forms: other
    parts of a mesh are solved as usual."""
    is_chosen = keywords["boundary"] == "free" or not keywords.keys().isdisjoint({"poles", "corners"})
    is_open = part.boundary_count > 0
    has_forms = not is_chosen and 2 * part.genus + part.boundary_count - is_open > 0
    if not (is_open and has_forms):
        keywords = keywords | {"boundary": "natural"}
    if keywords["solver"] == "paper" and not has_forms:
        keywords = keywords | {"solver": "auto"}
    return keywords


def name_vertices(keywords):
    """Whether the keywords name vertices."""
    return not keywords.keys().isdisjoint({"poles", "corners", "cuts"})


def on_surface(chosen, corner_vertices, surface):
    """The same `Choices` where vertices of the mesh were joined: the lowest of them stands for all."""
    if not len(surface.repairs.joined_vertices):
        return chosen
    lowest = np.arange(surface.given_vertex_count)
    lowest[corner_vertices[surface.corner_index]] = surface.vertex_index[surface.corner_vertices]
    vertices = chosen.vertices and tuple(dict.fromkeys(lowest[list(chosen.vertices)].tolist()))
    return replace(chosen, vertices=vertices, seams=lowest[chosen.seams])


def has_copies(part):
    """Whether vertices of the mesh are several on the part, where it was cut."""
    return bool((np.diff(part.vertex_index) == 0).any())


def in_part(keywords, part):
    """Keywords of vertices of the whole mesh as those of the part: the first copy of each, all copies of an edge."""
    own = {
        name: np.searchsorted(part.vertex_index, keywords[name]) for name in ("poles", "corners") if name in keywords
    }
    if "cuts" not in keywords:
        return keywords | own
    edges, count = holomorph.mesh.edges, part.given_vertex_count
    sides = edges.polygon_sides(part)
    keys, wanted = (edges.edge_keys(ends, count) for ends in (part.vertex_index[sides], keywords["cuts"]))
    return keywords | own | {"cuts": sides[np.isin(keys, wanted)]}


def ask_for_a_kind(keywords):
    """Whether the keywords say how the map is to be made, and not just how fast."""
    return name_vertices(keywords) or keywords["boundary"] != "natural" or keywords["solver"] == "paper"


def are_explicit(keywords, choices):
    """Whether the keywords hold what the library is to refuse where it does not fit."""
    return choices.is_explicit and not keywords.keys().isdisjoint({"poles", "corners"})


def numbers(text):
    """The complex numbers in a text like "1 1 -2" or "1+0.5j, -1-0.5j"; raises ValueError naming what is none."""
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


def stray_vertex(corner_vertices, choices):
    """The first explicitly chosen vertex that no face has, or None."""
    chosen = np.array(choices.vertices if choices.is_explicit else (), np.int64)
    stray = chosen[~np.isin(chosen, corner_vertices)]
    return int(stray[0]) if len(stray) else None


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
    # The library refuses a wrong number of residues.
    return {"poles": own, "residues": residues[is_own] if len(residues) == len(is_own) else residues}


def _are_corners_of_a_disk(part, vertices):
    if (part.genus, part.boundary_count) != (0, 1) or len(vertices) != CORNERS:
        return False
    border = part.vertex_index[holomorph.mesh.edges.boundary_edges(part)]
    return bool(np.isin(vertices, border).all())
