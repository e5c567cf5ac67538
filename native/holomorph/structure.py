"""conformal_structure: checks the options and chooses what is made by topology and options."""

from . import _native
from ._native import TopologyError
from .closed import ConformalStructure
from .results import check_options, only_component, result


def conformal_structure(surface, *, solver="auto", threads=None, progress=None):
    """Harmonic and holomorphic one-forms and the period matrix of one connected closed surface of genus >= 1.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    solver : "direct" is a sparse Cholesky factorisation, "multigrid" iterates in linear time and memory, "auto" chooses
        by size and number of right-hand sides; the result's `solver` says what was taken and why
    threads : number of threads, None for one per core; the result has the same bits for any number
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns
    -------
    ConformalStructure

    Raises
    ------
    TopologyError
        several components, genus 0, or a boundary (names genus and boundary count)
    SolverError
        if neither a residual of 1e-10 nor, among slivers, the level of rounding is reached, or memory runs out
    Cancelled
        if `progress` returned False

    Cost: 2g solves of the Laplacian, after one factorisation or the set-up of multigrid; 2 g #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 7 and Eq. 13; the star by Gu & Yau (2003), projected.
    """
    threads = check_options(solver, threads)
    component = only_component(surface)
    genus, boundaries = component.genus, component.boundary_count
    if genus >= 1 and boundaries == 0:
        native = _native.conformal_structure(component._native, solver, threads, progress)
        return result(ConformalStructure, surface, component, native)
    raise TopologyError(
        f"the surface has genus {genus} and {boundaries} boundary loops; a closed surface of genus 1 or more is needed"
    )
