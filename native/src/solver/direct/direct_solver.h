// The direct solver: a factorisation once, and a back-substitution for each block of right-hand sides.
#pragma once

#include "solver/laplace_solver.h"

namespace holomorph::solver {

/// The right-hand sides that share a back-substitution, at most.
Eigen::Index direct_block(Eigen::Index unknowns);

/// Sparse Cholesky with one vertex pinned (direct/sparse_cholesky.h), and iterative refinement. The fixed vertices are
/// eliminated last, so that one factorisation serves both conditions.
/// @param fixed vertices, ascending and distinct; none for a closed surface, where dirichlet must not be asked for
/// @throws SolverError if the factorisation fails; Cancelled before or after it
std::unique_ptr<LaplaceSolver> make_direct_solver(Laplacian&& L, std::vector<int> fixed, Execution& execution);

}  // namespace holomorph::solver
