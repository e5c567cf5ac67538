"""conformal_structure: forms and invariants of a surface that has holomorphic forms."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from .. import _native
from .._native import SolverError, TopologyError
from ..core.array_types import Progress
from ..core.value import quoted
from ..mesh.checks import check_bounds, check_memory_limit, check_options, check_thresholds, only_component
from ..mesh.surface import Surface
from .bounded import BoundedStructure
from .closed import ConformalStructure
from .narrow_bounds import narrow
from .results import result

BOUNDARIES = ("natural", "double_cover")


def conformal_structure(
    surface: Surface,
    *,
    boundary: str = "natural",
    solver: str = "auto",
    thresholds: Sequence[float] | None = None,
    threads: int | None = None,
    memory_limit: float | None = None,
    bounds: float | None = None,
    most_faces: int = 2_000_000,
    progress: Progress | None = None,
) -> ConformalStructure | BoundedStructure:
    """Conformal structure of one connected surface with handles or at least two boundary loops: harmonic and
    holomorphic one-forms, and conformal invariants.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    boundary : how forms of a surface with boundary are found: "natural" on the surface itself, "double_cover" on its
        double, at twice the size, as the paper does (§ 8); the forms are the same to solver accuracy
    solver : "direct", a sparse Cholesky factorisation; "multigrid", in linear time and memory; "auto" chooses, the
        result's `solver` says what and why; "paper", its multiresolution algorithm (§ 9), slower, on the surface's own
        triangles, its edges not flipped, and with any `boundary` on the double of each level
    thresholds : numbers of faces at which the paper's solver refines the forms on its way from the base mesh to the
        surface; None for one at every factor of four in faces from about 500 on. With none of them, [], its conjugate
        gradients begin at zero on the surface itself: what the paper compares with
    threads : number of threads, None for one per core; the result has the same bits for any number
    memory_limit : bytes that may be in use at once, without the surface itself; None refuses nothing but thousands of
        forms on a small mesh, beyond 1 GB and 100 kB for each vertex. Where the forms of a closed surface do not fit
        (None: in 2 GB), they are solved for in blocks, and `uv` solves for each map
    bounds : relative width that the bounds of the period matrix (capacities, modulus) are to have, such as 1e-8. Forms
        are then solved for again by elements of higher order, on triangles that are cut smaller towards cone points
        where the bounds lose most, until they are as narrow, or `most_faces` or `memory_limit` (None: 8 GB) would be
        exceeded; the result's `refinement` tells. UVs and forms remain those of the surface's own triangles
    most_faces : number of triangles up to which `bounds` may refine
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns a ConformalStructure of a closed surface of genus >= 1, a BoundedStructure of one with boundary

    Raises TopologyError for several components, and for spheres and disks, which have no forms; SolverError if neither
    a residual of 1e-10 nor, among thin triangles, an error of 1e-6 in energy is reached, or rounding leaves no digit of
    the invariants, or memory runs out, or `memory_limit` does not hold two right-hand sides (names the bytes that
    would); Cancelled.

    Cost: 2n solves of the Laplacian for n complex forms (n = g closed, 2g + b - 1 with boundary), after one
    factorisation or the set-up of multigrid; 2 n #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 8 and Eq. 13; the star by Gu & Yau (2003), projected.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(structure.period_matrix.shape, structure.certificate.holds)
    (3, 3) True
    """
    count, narrowing = check_options(solver, threads), check_bounds(bounds, most_faces)
    if boundary not in BOUNDARIES:
        raise ValueError(f"boundary is {quoted(boundary)}; one of {', '.join(BOUNDARIES)} is needed")
    limit, component = check_memory_limit(memory_limit), only_component(surface)
    _check_topology(component)
    options = solver, count, limit, progress
    native = _native_structure(component, boundary, check_thresholds(thresholds, solver), *options)
    kind = BoundedStructure if component.boundary_count else ConformalStructure
    more = {} if narrowing is None else {"refinement": _narrowed(native, narrowing, count, limit, progress)}
    again = {"boundary": boundary, "solver": solver, "thresholds": thresholds}
    again |= {"threads": threads, "memory_limit": memory_limit}
    made = result(kind, surface, component, native, count, **more)
    return made.computed_by(partial(conformal_structure, surface, bounds=bounds, most_faces=most_faces, **again))


def _check_topology(component):
    topology = component.genus, component.boundary_count
    if topology == (0, 0):
        raise TopologyError("a closed surface of genus 0 has no holomorphic forms; log_map gives its differential")
    if topology == (0, 1):
        maps = "disk_map, rectangle_map and free_boundary_map"
        raise TopologyError(f"a disk has no holomorphic forms; {maps} give maps of it")


def _native_structure(component, boundary, thresholds, solver, threads, memory_limit, progress):
    if solver == "paper":
        return _native.paper_structure(component._native, thresholds, threads, memory_limit, progress)
    is_double = component.boundary_count > 0 and boundary == "double_cover"
    return _native.conformal_structure(component._native, is_double, solver, threads, memory_limit, progress)


def _narrowed(native, narrowing, threads, memory_limit, progress):
    """The `Refinement`; the bounds of `native` become narrower."""
    if not native.memory().keeps_forms:
        raise SolverError("narrowing the bounds needs all forms in memory; these were solved for in blocks")
    return narrow(native, *narrowing, threads, memory_limit, progress)
