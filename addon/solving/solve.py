# SPDX-License-Identifier: GPL-3.0-or-later
"""From polygons to conformal structures, component by component. No bpy here: it runs in a worker thread."""

import functools
import time
from dataclasses import dataclass, field, replace

from .. import native
from . import choices

DOUBLES_OF_TILER = 40  # for each edge: half-edges, weights, the multigrid hierarchy
DOUBLES_OF_TILING = 6  # for each corner: UVs and quality
KEPT_TILINGS = 4  # of each part: the redo panel goes back and forth between a few
NO_ISLANDS = "no seams cut it open: mark some in edit mode (Edge > Mark Seam), or take another main map"
NO_HARD_EDGES = "no edge is that hard: choose a smaller angle, mark seams in edit mode, or take another main map"
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

    The structure is what `choices.structure` gives for the part's topology and the choices, with the
    vertices as the whole mesh counts them, and the corners as the part does. All kinds have `uv(coefficients)`,
    `balanced_coefficients()`, `quality`, `seams`, `description` and `invariants()`.
    """

    surface: object
    structure: object | None
    balanced: object | None  # coefficients of the main map: complex, real on bounded surfaces, none for a fixed map
    reason: str = ""
    note: str = ""  # which choice was not followed, and why
    is_chosen: bool = False  # whether a choice of the user was followed
    frames: dict = field(default_factory=dict, compare=False)  # bounding box and area of each map
    main_maps: dict = field(default_factory=dict, compare=False)  # `forms.MainMap` by dials
    tilings: dict = field(default_factory=dict, compare=False)  # `mapped.MappedPart` by what was asked, newest last
    last_rounded: dict = field(default_factory=dict, compare=False)  # (`options.TileOptions`, its tiling) by the tiler

    @property
    def form_count(self):
        """How many forms there are to mix."""
        return 0 if self.balanced is None else len(self.balanced)

    def keep_tiling(self, asked, part):
        """Adds one, and drops the oldest beyond `KEPT_TILINGS`."""
        self.tilings[asked] = part
        while len(self.tilings) > KEPT_TILINGS:
            del self.tilings[next(iter(self.tilings))]

    @property
    def area(self):
        """The area of the component's surface."""
        return self.surface.area

    @property
    def size(self):
        """About how many doubles are held: harmonic forms and potentials; of a tiler also a solver; and of tilings."""
        forms, tiler = 4 * self.form_count + 4, 2 * self.form_count + DOUBLES_OF_TILER
        of_edges = (forms + bool(self.tilings) * tiler) * len(self.structure.edges)
        return of_edges + len(self.tilings) * DOUBLES_OF_TILING * len(self.surface.corner_vertices)


@dataclass(frozen=True)
class SolvedObject:
    """The components of one object in the library's order, the mesh as given, and the surface in it."""

    surface: object
    polygons: object
    components: tuple
    seconds: float

    @property
    def done(self):
        """The components that have maps."""
        return [c for c in self.components if c.structure is not None]

    @property
    def form_count(self):
        """The largest number of forms among the components."""
        return max((c.form_count for c in self.components), default=0)

    @property
    def size(self):
        """About how many doubles the parts hold."""
        return sum(c.size for c in self.done)


def solve(task, progress=None):
    """The conformal structure of every component.

    progress(fraction, stage) returning False cancels. Raises `holomorph.Error` for a mesh that cannot be treated as a
    whole, and where an explicit choice of vertices does not fit the part they lie on.
    """
    holomorph = native.load()
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
        solved.append(
            _solve_component(holomorph, make, part, chosen, holomorph.progress.scaled(progress, done, done + share))
        )
        done += share
    return SolvedObject(surface, polygons, tuple(solved), time.perf_counter() - start)


def _parts(holomorph, surface, chosen, progress):
    """The connected components, or the islands between the seams. Seams may be edges of no face that is mapped."""
    if not chosen.are_islands:
        return surface.components
    between_seams = holomorph.islands(surface, chosen.seams, strict=False, hard_edges=chosen.hard_edges or None)
    islands = [disk for part in between_seams for disk in _opened(holomorph, part, progress)]
    if chosen.most_stretch > 1:
        islands = [_cut_to_cones(holomorph, part, chosen.most_stretch, progress) for part in islands]
    if any(part.genus == 0 and part.boundary_count == 1 for part in islands):
        return islands
    raise holomorph.TopologyError(NO_HARD_EDGES if chosen.hard_edges else NO_ISLANDS)


def _opened(holomorph, part, progress):
    """A part with several boundary loops, or with a boundary and handles, cut open to a disk; others as they are."""
    if part.boundary_count == 0 or (part.genus, part.boundary_count) == (0, 1):
        return (part,)
    try:
        structure = holomorph.conformal_structure(part, progress=holomorph.progress.scaled(progress, 0.0, 0.0))
    except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError):
        return (part,)  # what is wrong with it is said where its map is made
    return holomorph.islands(part, part.vertex_index[structure.edges[structure.seams]])


def _cut_to_cones(holomorph, part, most_stretch, progress):
    """A disk cut open where its flat map would be stretched more; others as they are."""
    if (part.genus, part.boundary_count) != (0, 1):
        return part
    try:
        return holomorph.cut_to_cones(part, most_stretch, progress=holomorph.progress.scaled(progress, 0.0, 0.0))
    except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError):
        return part  # what is wrong with it is said where its map is made


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
        return SolvedComponent(part, None, None, reason=native.sentence(error), note=note)


def _make(holomorph, surface, vertices, part, keywords, note, progress):
    target, scaled = part, holomorph.progress.scaled
    if choices.name_vertices(keywords) and choices.has_copies(part):
        keywords = choices.in_part(keywords, part)
    elif choices.name_vertices(keywords):
        # The part's faces with all of the mesh's vertices: then the library names vertices by the mesh's indices.
        corners = part.vertex_index[part.corner_vertices]
        target = holomorph.Surface.from_polygons(vertices, corners, part.face_offsets)
    structure = choices.structure(holomorph, target, keywords, scaled(progress, 0.0, UV_START))
    structure.prepare_uv(scaled(progress, UV_START, 1.0))
    structure = replace(structure, surface=surface)  # so do its results
    balanced, is_chosen = structure.balanced_coefficients(), choices.ask_for_a_kind(keywords)
    structure.uv(balanced)  # refused here, where it is not finite, before anything is written
    return SolvedComponent(part, structure, balanced, note=note, is_chosen=is_chosen)
