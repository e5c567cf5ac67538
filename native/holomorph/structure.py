"""conformal_structure: checks the options and chooses what is made by topology and options."""

from . import _native
from ._native import TopologyError
from .bounded import BoundedStructure
from .closed import ConformalStructure
from .punctured import PuncturedStructure
from .results import check_options, only_component, own_vertices, result
from .truncated import coarse_log_map


def conformal_structure(surface, *, punctures=None, residues=None, solver="auto", threads=None, progress=None):
    """Conformal structure of one connected surface: harmonic and holomorphic one-forms and conformal invariants; with
    punctures, and on genus 0, a differential of the third kind.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    punctures : list of vertices whose stars are apart from each other; without any, two far apart are taken on genus 0
    residues : list of complex numbers, one for each puncture, not 0 and summing to 0: the UVs change by it around the
        puncture. Default: 1 and -1 for two punctures; for more, 1 but at the one that is farthest from the others
    solver : "direct" is a sparse Cholesky factorisation, "multigrid" iterates in linear time and memory, "auto" chooses
        by size and number of right-hand sides; the result's `solver` says what was taken and why. "paper" is the
        multiresolution algorithm of the paper (§ 9) for closed surfaces with positions, slower than the others and
        never chosen by "auto": conjugate gradients on the levels of a progressive mesh, whose base mesh gives loops and
        classes. It turns no edges, so its invariants are those of the artist's triangles
    threads : number of threads, None for one per core; the result has the same bits for any number
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns
    -------
    ConformalStructure of a closed surface of genus >= 1, BoundedStructure of one with boundary, PuncturedStructure of
    one with punctures

    Raises
    ------
    TopologyError
        several components; a disk (names genus and boundary count); punctures or residues that do not fit
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
    vertices, names = own_vertices(surface, component, [] if punctures is None else punctures, "puncture")
    chosen = vertices, _residues(residues), names
    is_chosen = any(map(len, chosen[:2]))
    if is_chosen or (genus == 0 and boundaries == 0):
        try:
            native = _native.punctured_structure(component._native, *chosen, solver, threads, progress)
        except TopologyError:
            if is_chosen or component.vertices is None:
                raise
            return coarse_log_map(surface, component, solver, threads, progress)  # the stars of any two vertices meet
        return result(PuncturedStructure, surface, component, native)
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


def _residues(residues):
    try:
        return [] if residues is None else [complex(r) for r in residues]
    except TypeError as error:
        raise TopologyError(f"residues must be a list of numbers, not {residues!r}") from error
