// The multigrid solver: time and memory linear in the size.
#pragma once

#include <vector>

#include "base/execution.h"
#include "solver/laplace_solver.h"

namespace holomorph::solver {

/// Whether vertices with consecutive numbers have neighbours that are far apart: most entries of the rows are far from
/// every entry of the row before. False if all blocks of unknowns fit into a processor's cache anyway.
/// Cost: one pass over an eighth of the entries.
bool is_scattered(const Laplacian& L);

/// Returns all vertices, breadth first from vertex 0 (and from the next one that is left, where L is not connected).
/// @throws Cancelled
std::vector<int> breadth_first_order(const Laplacian& L, Execution& execution);

/// Returns the same symmetric matrix in another order. @param order the old number of each new one, a permutation
Laplacian renumbered(const Laplacian& L, const std::vector<int>& order);

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
