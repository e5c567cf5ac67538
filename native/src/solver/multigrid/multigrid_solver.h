// The multigrid solver: time and memory linear in the size.
#pragma once

#include "solver/laplace_solver.h"

namespace holomorph::solver {

/// Conjugate gradients for up to 8 right-hand sides at once, preconditioned by algebraic multigrid in single precision
/// inside a correction in double precision. Takes weights of any sign, with fewer iterations where none is negative.
/// Where it does not converge, the direct solver takes its place, and the remark says so. The bits of the result do not
/// depend on the number of threads.
/// @param fixed vertices, ascending and distinct
/// @param goal relative residual to go on to while that helps, at most kResidual
/// @throws SolverError if the direct solver fails as well; Cancelled.
/// Cost on one thread: about 0.6 us per vertex, and 1.2 us per vertex and 4 right-hand sides. It takes 0.45 KB per
/// vertex for 4 right-hand sides.
std::unique_ptr<LaplaceSolver> make_multigrid_solver(Laplacian&& L, std::vector<int> fixed, double goal,
                                                     Execution& execution);

}  // namespace holomorph::solver
