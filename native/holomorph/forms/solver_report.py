"""Reports on a solve: the solver and why it was chosen, residuals, memory."""

from dataclasses import dataclass
from typing import Self

from ..core.value import Value, counted


@dataclass(frozen=True, repr=False)
class SolverReport(Value):
    """Which solver was used and why; iterations (of multigrid or, by the paper's solver, on the surface itself; steps
    of iterative refinement of the direct solver); the largest relative residual of the linear systems, or where forms
    were refined, among thin triangles, their largest relative error in energy.

    levels : (faces, iterations, seconds) of the paper's solver on each level of the progressive mesh, the base mesh
        first and the surface last, where the seconds of a level include making its linear system, with boundary that of
        its double; () for other solvers
    """

    name: str
    reason: str
    iterations: int
    residual: float
    levels: tuple[tuple[int, int, float], ...] = ()

    @classmethod
    def of(cls, native: object) -> Self:
        """Makes one of a native report."""
        levels = tuple((level.faces, level.iterations, level.seconds) for level in native.levels)
        return cls(native.name, native.reason, native.iterations, native.residual, levels)

    def _facts(self):
        return [self.name, self.reason, counted(self.iterations, "iteration"), f"residual {self.residual:.2g}"]


@dataclass(frozen=True)
class Residuals:
    """Relative maxima over all harmonic forms, on the intrinsic triangulation that was solved on.

    closedness: sum around a face over the largest value of the form; harmonicity: sum of k h at a vertex over the
    largest sum of |k h|; periods: difference of the integral of h_j over zeta_i from delta_ij.
    """

    closedness: float
    harmonicity: float
    periods: float


@dataclass(frozen=True)
class ClosedResiduals(Residuals):
    """And asymmetry: largest difference between the Gram matrix and its transpose, before it was made symmetric, over
    its largest entry, where the forms were not kept; else 0."""

    asymmetry: float


@dataclass(frozen=True)
class MemoryPlan:
    """How a computation keeps within `memory_limit`. keeps_forms: all harmonic functions are kept in memory, else each
    block of forms is freed once measured; block: right-hand sides solved for at a time; bytes: estimate of the most
    memory in use at once, without the surface itself; not less than what was measured, and up to 2.5 times that, 30 MB
    more of small surfaces."""

    keeps_forms: bool
    block: int
    bytes: int


@dataclass(frozen=True)
class BoundedResiduals(Residuals):
    """Those of both families; harmonicity at every vertex for the natural forms, at the inner ones for the Dirichlet
    forms; periods of the natural forms. pairing: largest difference of the integral of h^N_i ^ h from what the integers
    W say, for one h = sum of +-h^D_j."""

    pairing: float
