// The levels of the multigrid preconditioner: an algebraic relative of the paper's progressive mesh (§ 3).
//
// Moving an F-point to the C-neighbour of largest weight is an edge collapse, and a step of coarsening is a batch of
// them. So the hierarchy is a progressive mesh, read by batches of vertex splits. Two things differ. The steps see the
// matrix alone, so no coarse mesh has to be valid. A value is interpolated from several coarse ones (P), not from the
// parent's alone, and coarse operators are P^T A P.
#pragma once

#include <Eigen/Core>

#include "solver/laplace_solver.h"
#include "solver/multigrid/coarsening.h"
#include "solver/multigrid/wavefront.h"

namespace holomorph::solver {

struct CoarsestInverse {
  Eigen::MatrixXf natural;    ///< pseudo-inverse of A
  Eigen::MatrixXf dirichlet;  ///< inverse of the part of A without the fixed vertices, 0 at these; empty without any
};

/// Both symmetric, computed in double precision. Cost: cubic in the size of A, which is a few hundred.
/// @throws SolverError if A is not positive semi-definite
CoarsestInverse coarsest_inverse(const Operator& coarsest);

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

struct Level {
  Operator op;
  EqualRows P;     ///< interpolation from the next level; rows sum to 1; empty on the coarsest level
  SparseRows R;    ///< restriction to the next level, its transpose; like what follows empty on the coarsest level
  Wavefront down;  ///< a loop over the rows, and one that applies R to its results
  Wavefront up;    ///< a loop over the rows, one that applies A to its results, and one more that applies A to those

  int rows() const { return op.A.size(); }
};

/// Rows of the next level that go with a chunk of this level's.
inline int coarse_rows_per_chunk(const Level& level) {
  const int chunks = row_chunks(level.rows());
  return (level.R.size() + chunks - 1) / chunks;
}

/// One hierarchy serves both conditions. The fixed vertices of a coarse level are fixed on the finer one, too, and a
/// fixed vertex takes its value from fixed ones alone. So a function that is 0 at the fixed vertices of one level is 0
/// at those of all.
struct Hierarchy {
  std::vector<Level> levels;  ///< finest first
  CoarsestInverse coarsest;
};

/// Coarsens until 250 vertices are left.
/// @param fixed vertices, distinct
/// @throws SolverError if the graph cannot be coarsened further or the matrix is not semi-definite; Cancelled
/// Cost: linear; about 0.2 KB and 0.5 us per vertex.
Hierarchy make_hierarchy(const Laplacian& L, const std::vector<int>& fixed, Execution& execution);

}  // namespace holomorph::solver
