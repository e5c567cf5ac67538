"""conformal_structure: checks the options and selects the kind of structure by topology and options."""

from collections.abc import Sequence
from copy import deepcopy
from functools import partial
from typing import TypeAlias

from numpy.typing import ArrayLike

from . import _native
from ._native import SolverError, TopologyError
from .array_types import Complexes, Integers, Progress
from .bounded import BoundedStructure
from .checks import check_bounds, check_memory_limit, check_options, only_component, own_vertices
from .closed import ConformalStructure
from .cut import cut_along
from .disk import (
    DiskMap,
    FreeBoundaryMap,
    RectangleMap,
    TriangleMap,
    automatic_disk_map,
    disk,
    free_boundary,
    rectangle,
)
from .narrow_bounds import narrow
from .punctured import PuncturedStructure
from .results import result
from .surface import Surface
from .truncated import coarse_log_map

BOUNDARIES = ("natural", "double_cover", "free")
AnyStructure: TypeAlias = (
    ConformalStructure | BoundedStructure | PuncturedStructure | DiskMap | FreeBoundaryMap | RectangleMap | TriangleMap
)


def conformal_structure(
    surface: Surface,
    *,
    boundary: str = "natural",
    punctures: Sequence[int] | Integers | None = None,
    residues: Sequence[complex] | Complexes | None = None,
    rectangle_corners: Sequence[int] | Integers | None = None,
    cut_edges: ArrayLike | None = None,
    solver: str = "auto",
    threads: int | None = None,
    memory_limit: float | None = None,
    bounds: float | None = None,
    most_faces: int = 2_000_000,
    progress: Progress | None = None,
) -> AnyStructure:
    """Conformal structure of one connected surface: harmonic and holomorphic one-forms and conformal invariants; with
    punctures, and on genus 0, a differential of the third kind.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    boundary : how forms of a surface with boundary are found: "natural" on the surface itself, "double_cover" on its
        double, at twice the size, as the paper does (§ 8); the forms are the same to solver accuracy; "free"
        for the map of a disk that keeps lengths along the boundary, with the least variation of density
    punctures : list of vertices whose stars are apart from each other and from the boundary; without any, two far apart
        are taken on a closed surface of genus 0. One of a disk, without residues, makes its map to the unit disk
    residues : list of complex numbers other than 0, one for each puncture: the UVs change by it around the puncture. On
        a closed surface they sum to 0. Default: 1 and -1 for two punctures; for more, 1 but at the one that is farthest
        from the others; with a boundary 1 everywhere
    rectangle_corners : list of four boundary vertices of a disk in the order of the boundary, the surface on its left:
        makes its map to a rectangle. Without a choice: by clear corners, else round or more even; `description` tells
    cut_edges : (#S, 2) vertices of the edges along which UVs are cut, such as marked seams; default: the cut graph. The
        map must be single-valued on the rest, as it is on disks
    solver : "direct", a sparse Cholesky factorisation; "multigrid", in linear time and memory; "auto" chooses, the
        result's `solver` says what and why; "paper", its multiresolution algorithm (§ 9) for closed surfaces, slower,
        on the surface's own triangles, its edges not flipped
    threads : number of threads, None for one per core; the result has the same bits for any number
    memory_limit : bytes that may be in use at once, without the surface itself; None refuses nothing. Where the forms
        of a closed surface do not fit (None: in 2 GB), they are solved for in blocks, and `uv` solves for each map
    bounds : relative width that the bounds of the period matrix (capacities, modulus) are to have, such as 1e-4. The
        surface is then refined inside, by intrinsic triangles where its bounds lose most, until they are as narrow or
        `most_faces` would be exceeded; the result's `refinement` tells. UVs and forms remain those of the surface's own
        triangles. For surfaces with handles or at least two boundary loops
    most_faces : number of triangles up to which `bounds` may refine
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns
    -------
    ConformalStructure of a closed surface of genus >= 1, BoundedStructure of one with boundary, PuncturedStructure of
    one with punctures, DiskMap, RectangleMap, FreeBoundaryMap or (for three boundary edges) TriangleMap of a disk

    Raises TopologyError for several components, and for punctures, residues or corners that do not fit; SolverError if
    neither a residual of 1e-10 nor, among thin triangles, an error of 1e-6 in energy is reached, or rounding leaves no
    digit of the invariants, or memory runs out, or `memory_limit` does not hold two right-hand sides (names the bytes
    that would); Cancelled.

    Cost: 2n solves of the Laplacian for n complex forms (n = g closed, 2g + b - 1 with boundary), after one
    factorisation or the set-up of multigrid; 2 n #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 8 and Eq. 13; the star by Gu & Yau (2003), projected.
    """
    residues = _residues(residues)
    given = locals() | {"progress": None}  # all arguments: no other name is there yet
    options = solver, check_options(solver, threads), progress
    narrowing = check_bounds(bounds, most_faces)
    if boundary not in BOUNDARIES:
        raise ValueError(f"boundary is {boundary!r}; one of {', '.join(BOUNDARIES)} is needed")
    memory_limit = check_memory_limit(memory_limit)
    component = only_component(surface)
    chosen = punctures, residues, rectangle_corners
    made = _structure(surface, component, boundary, chosen, options, memory_limit, narrowing)
    if cut_edges is not None and len(cut_edges):
        made = cut_along(made, surface, component, cut_edges)
    return made.computed_by(partial(conformal_structure, **deepcopy(given)))  # the caller's lists may change


def _structure(surface, component, boundary, chosen, options, memory_limit, narrowing):
    punctures, residues, rectangle_corners = chosen
    topology = component.genus, component.boundary_count
    vertices, labels = own_vertices(surface, component, [] if punctures is None else punctures, "puncture")
    is_chosen = bool(vertices or residues)
    if narrowing is not None:
        _check_narrowing(topology, is_chosen or rectangle_corners is not None)
    if boundary == "double_cover":
        _check_double_cover(topology, is_chosen or rectangle_corners is not None)
    if boundary == "free":
        _check_free_boundary(is_chosen or rectangle_corners is not None)
        return free_boundary(surface, component, *options)
    if rectangle_corners is not None and len(rectangle_corners):
        _check_no_punctures(is_chosen)
        return rectangle(surface, component, rectangle_corners, *options)
    if topology == (0, 1) and len(vertices) <= 1 and not residues:
        return _disk(surface, component, vertices, labels, options)
    if is_chosen or topology == (0, 0):
        return _punctured(surface, component, (vertices, residues, labels), options, memory_limit)
    return _forms(surface, component, boundary, options, memory_limit, narrowing)


def _check_double_cover(topology, has_choice):
    if has_choice or topology == (0, 1):
        raise TopologyError(
            "the way over the double is for forms of surfaces with boundary, without punctures or corners"
        )


def _check_free_boundary(has_choice):
    if has_choice:
        raise TopologyError("a map with a free boundary has no punctures or corners; choose either")


def _check_narrowing(topology, has_choice):
    if has_choice or topology in ((0, 0), (0, 1)):
        raise TopologyError(
            "bounds can be narrowed on surfaces with handles or two boundary loops, without punctures or corners"
        )


def _check_no_punctures(is_chosen):
    if is_chosen:
        raise TopologyError("a rectangle has no punctures; choose either")


def _disk(surface, component, vertices, labels, options):
    if vertices:
        return disk(surface, component, vertices, labels, *options)
    return automatic_disk_map(surface, component, *options)


def _punctured(surface, component, chosen, options, memory_limit):
    solver, threads, progress = options
    try:
        native = _native.punctured_structure(component._native, *chosen, solver, threads, memory_limit, progress)
    except TopologyError:
        if any(map(len, chosen[:2])) or component.vertices is None:
            raise
        return coarse_log_map(surface, component, *options)  # the stars of any two vertices meet
    return result(PuncturedStructure, surface, component, native, threads)


def _forms(surface, component, boundary, options, memory_limit, narrowing):
    solver, threads, progress = options
    bounded = component.boundary_count > 0
    if solver == "paper" and not bounded:
        native = _native.paper_structure(component._native, threads, memory_limit, progress)
    else:
        limited = solver, threads, memory_limit, progress
        native = _native.conformal_structure(component._native, bounded and boundary == "double_cover", *limited)
    kind = BoundedStructure if bounded else ConformalStructure
    if narrowing is None:
        return result(kind, surface, component, native, threads)
    if not native.memory()[0]:
        raise SolverError("bounds are narrowed with all forms in memory; they were solved for in blocks")
    refinement = narrow(native, *narrowing, "auto" if solver == "paper" else solver, threads, memory_limit, progress)
    return result(kind, surface, component, native, threads, refinement=refinement)


def _residues(residues):
    try:
        return [] if residues is None else [complex(r) for r in residues]
    except (TypeError, ValueError) as error:
        raise TopologyError(f"residues must be a list of numbers, not {residues!r}") from error
