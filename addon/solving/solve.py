# SPDX-License-Identifier: GPL-3.0-or-later
"""From polygons to conformal structures, component by component. No bpy here: it runs in a worker thread."""

import functools
import itertools
import time
from dataclasses import dataclass, field, replace

import numpy as np

from .. import native
from ..native import holomorph
from . import choices

DOUBLES_OF_TILER = 40  # for each edge: half-edges, weights, the multigrid hierarchy
DOUBLES_OF_MAP = 6  # for each corner: UVs and quality
KEPT_MAPS = 4  # maps kept for each object: the redo panel goes back and forth between a few
NO_ISLANDS = "no seams cut it open: mark some in edit mode (Edge > Mark Seam), or take another main map"
NO_HARD_EDGES = "no edge is that sharp: choose a smaller angle, mark seams in edit mode, or take another main map"
UV_START = 0.6  # fraction of the work after which the potentials of the maps are solved for


@dataclass(frozen=True)
class Task:
    """A mesh to solve, and what was chosen on it."""

    polygons: object
    chosen: choices.Choices = choices.Choices()

    def equals(self, other):
        """Whether the other one has the same result."""
        return self.chosen.key == other.chosen.key and self.polygons.equals(other.polygons)


@dataclass(frozen=True)
class SolvedComponent:
    """A connected part of the object; `structure` is None where the library refused it, and `reason` says why.

    The structure is what `holomorph.automatic_structure` gives for the part's topology and the choices, with the
    vertices as the whole mesh counts them, and the corners as the part does. All kinds have `uv(coefficients)`,
    `balanced_coefficients()`, `quality`, `seams`, `description` and `invariants()`.
    """

    surface: object
    structure: object | None
    reason: str = ""
    note: str = ""  # which choice was not followed, and why
    is_chosen: bool = False  # whether a choice of the user was followed

    @property
    def form_count(self):
        """How many forms there are to mix."""
        return 0 if self.structure is None else self.structure.form_count

    @property
    def area(self):
        """The area of the component's surface."""
        return self.surface.area


@dataclass(frozen=True, eq=False)
class SolvedObject:
    """The components of one object in the library's order, the mesh as given, and the surface in it."""

    surface: object
    polygons: object
    components: tuple
    seconds: float
    # What `mapped` made of it by what was asked, newest last: the `mapped.MappedPart`s, and a size for them.
    maps: dict = field(default_factory=dict)
    number: int = field(default_factory=itertools.count().__next__)  # no other one has it

    @property
    def done(self):
        """The components that have maps."""
        return [c for c in self.components if c.structure is not None]

    @property
    def form_count(self):
        """The largest number of forms among the components."""
        return max((c.form_count for c in self.components), default=0)

    def keep_maps(self, asked, made):
        """Adds those of the `done` components, and drops the oldest beyond `KEPT_MAPS`."""
        self.maps[asked] = made
        while len(self.maps) > KEPT_MAPS:
            del self.maps[next(iter(self.maps))]

    @property
    def size(self):
        """About how many doubles are held: harmonic forms and potentials; of tilers also solvers; and maps."""
        has_tilings = any(part.tiling for parts, _ in self.maps.values() for part in parts)
        per_form, per_edge = (6, 4 + DOUBLES_OF_TILER) if has_tilings else (4, 4)
        of_edges = sum((per_form * c.form_count + per_edge) * len(c.structure.edges) for c in self.done)
        corners = sum(len(c.surface.corner_vertices) for c in self.done)
        return of_edges + len(self.maps) * DOUBLES_OF_MAP * corners


def solve(task, progress=None):
    """The conformal structure of every component.

    progress(fraction, stage) returning False cancels. Raises `holomorph.Error` for a mesh that cannot be treated as a
    whole, and where an explicit choice of vertices does not fit the part they lie on.
    """
    start = time.perf_counter()
    polygons, surface = task.polygons, task.polygons.surface(strict=False)
    polygons.share(surface)
    chosen = choices.on_surface(task.chosen, polygons.corner_vertices, surface)
    parts = _parts(holomorph, surface, chosen, progress)
    stray = choices.stray_vertex(polygons.corner_vertices, task.chosen)
    if stray is not None:
        raise holomorph.InvalidMesh(f"vertex {stray} belongs to no face and cannot be chosen")
    total = max(sum(len(p.face_index) for p in parts), 1)
    solved, done = [], 0
    for part in parts:
        share = len(part.face_index) / total
        make = functools.partial(_make, holomorph, surface, polygons.vertices, part)
        shown = holomorph.core.progress.scaled(progress, done, done + share)
        solved.append(_solve_component(holomorph, make, part, chosen, shown))
        done += share
    return SolvedObject(surface, polygons, tuple(solved), time.perf_counter() - start)


def _parts(holomorph, surface, chosen, progress):
    """The connected components, or the islands between the seams. Seams may be edges of no face that is mapped."""
    if not chosen.are_islands:
        return surface.components
    stretch = chosen.most_stretch if chosen.most_stretch > 1 else None
    options = {"hard_edges": chosen.hard_edges or None, "most_stretch": stretch}
    islands = holomorph.disk_islands(surface, chosen.seams, strict=False, progress=progress, **options)
    if any(part.genus == 0 and part.boundary_count == 1 for part in islands):
        return islands
    raise holomorph.TopologyError(NO_HARD_EDGES if chosen.hard_edges else NO_ISLANDS)


def _solve_component(holomorph, make, part, chosen, progress):
    """The first attempt that the library accepts; a part that it refuses altogether is skipped, with its sentence."""
    note = ""
    *earlier, last = choices.attempts(part, chosen)
    for keywords in earlier:
        try:
            return make(keywords, note, progress)
        except (holomorph.InvalidMesh, holomorph.TopologyError) as error:
            note = note or native.sentence(error)
    try:
        return make(last, note, progress)
    except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError) as error:
        if choices.are_explicit(last, chosen):
            raise
        return SolvedComponent(part, None, reason=native.sentence(error), note=note)


def _make(holomorph, surface, vertices, part, keywords, note, progress):
    target, scaled = part, holomorph.core.progress.scaled
    if choices.name_vertices(keywords) and choices.has_copies(part):
        keywords = choices.in_part(keywords, part)
    elif choices.name_vertices(keywords):
        # The part's faces with all of the mesh's vertices: then the library names vertices by the mesh's indices.
        corners = part.vertex_index[part.corner_vertices]
        target = holomorph.Surface.from_polygons(vertices, corners, part.face_offsets)
    structure = holomorph.automatic_structure(target, **keywords, progress=scaled(progress, 0.0, UV_START))
    structure.prepare_uv(scaled(progress, UV_START, 1.0))
    structure = replace(structure, surface=surface)  # so do its results
    units = np.eye(structure.form_count, dtype=structure.coefficient_type)
    structure.uv(units[0] if len(units) else ())  # refused here, where it is not finite, before anything is written
    return SolvedComponent(part, structure, note=note, is_chosen=choices.ask_for_a_kind(keywords))
