"""conformal_structure: checks the options and chooses what is made by topology and options."""

from . import _native
from ._native import TopologyError
from .bounded import BoundedStructure
from .closed import ConformalStructure
from .results import check_options, only_component, result


def conformal_structure(surface, *, solver="auto", threads=None, progress=None):
    """Harmonic and holomorphic one-forms and conformal invariants of one connected surface: closed of genus >= 1, or
    with boundary, except a disk.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    solver : "direct" is a sparse Cholesky factorisation, "multigrid" iterates in linear time and memory, "auto" chooses
        by size and number of right-hand sides; the result's `solver` says what was taken and why
    threads : number of threads, None for one per core; the result has the same bits for any number
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns
    -------
    ConformalStructure of a closed surface, BoundedStructure of one with boundary

    Raises
    ------
    TopologyError
        several components, a sphere or a disk (names genus and boundary count)
    SolverError
        if neither a residual of 1e-10 nor, among slivers, the level of rounding is reached, or memory runs out
    Cancelled
        if `progress` returned False

    Cost: 2n solves of the Laplacian for n complex forms (n = g closed, 2g + b - 1 with boundary), after one
    factorisation or the set-up of multigrid; 2 n #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 8 and Eq. 13; the star by Gu & Yau (2003), projected.
    """
    threads = check_options(solver, threads)
    component = only_component(surface)
    genus, boundaries = component.genus, component.boundary_count
    if boundaries and 2 * genus + boundaries > 1:
        native = _native.bounded_structure(component._native, solver, threads, progress)
        return result(BoundedStructure, surface, component, native)
    if genus >= 1:
        native = _native.conformal_structure(component._native, solver, threads, progress)
        return result(ConformalStructure, surface, component, native)
    raise TopologyError(
        f"the surface has genus {genus} and {boundaries} boundary loops; "
        "a closed surface of genus 1 or more, or one with a boundary that is no disk, is needed"
    )
