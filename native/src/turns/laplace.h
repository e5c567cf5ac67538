// The Laplacian of a net, on which each hole is one vertex.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/direct/sparse_cholesky.h"
#include "turns/net.h"

namespace holomorph::turns {

/// Solves L u = b: u is one number along each boundary loop, and its mean over the surface is 0. What b has in sum is
/// taken away evenly. It is natural at no boundary: nothing is asked of the direction there.
class Laplace {
 public:
  /// @throws SolverError @pre the net outlives it
  explicit Laplace(const Net& net);

  /// @param B #V x n. @return #V x n
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B);

 private:
  const Net& net_;
  std::vector<int> unknown_;  // #V
  Eigen::VectorXd area_;      // of the unknowns, 1 in sum
  solver::SparseCholesky factor_;
};

/// The vertex that stands for all of a boundary loop; otherwise the vertex itself.
inline int place_of(const Net& net, int v) { return net.hole[v] < 0 ? v : net.hole[v]; }

}  // namespace holomorph::turns
