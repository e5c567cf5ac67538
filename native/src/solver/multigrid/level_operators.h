// The operators of the levels: the given matrix in single precision, and P^T A P.
#pragma once

#include "solver/laplacian.h"
#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {

/// Takes over the weights of L, without those that are only rounding.
/// @param fixed one flag per vertex, or empty for none
/// @throws std::bad_alloc, Cancelled
Operator finest_operator(const Laplacian& L, Array<char> fixed, Execution& execution);

/// Computes P^T A P, summed in double precision. It is kept as differences, since its rows sum to 0. A coarse vertex is
/// fixed where its C-point is.
/// @param P interpolation() @param R its transpose
/// @throws std::bad_alloc, Cancelled
/// Cost: linear, in parallel.
Operator coarse_operator(const Operator& fine, const Coarsening& coarse, const EqualRows& P, const SparseRows& R,
                         Execution& execution);

}  // namespace holomorph::solver
