// The log scale of a flat metric with cones, as a quadratic form in the cones.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "solver/direct/sparse_cholesky.h"
#include "tiling/cones/net.h"

namespace holomorph::tiling {

/// The Laplacian of a net, on which each hole is one vertex. Solves L u = b: u is one number along each boundary loop,
/// and its mean over the surface is 0. What b has in sum is taken away evenly. It is natural at no boundary: nothing is
/// asked of the direction there.
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

/// With n k-th turns missing at candidates, L u = (2 pi / k) n - defect has the integral of u^2, over an area of 1,
///     n^T Q n - 2 b^T n + constant.
/// With G the Green's function of a candidate and W the areas, Q is L^-1 W G at the other candidates: it is read off,
/// and kept for the next candidates.
class ScaleForm {
 public:
  /// @throws SolverError @pre the net outlives it
  ScaleForm(const Net& net, int k);

  /// Takes candidates: ascending vertices. @param report is called before every few solutions
  void take(const std::vector<int>& places, const std::function<void()>& report);

  int total() const { return total_; }                          ///< the sum of n
  double unit() const { return unit_; }                         ///< a k-th turn
  const Eigen::VectorXd& without_cones() const { return u0_; }  ///< #V, u for n = 0
  double constant() const { return constant_; }
  const Eigen::MatrixXd& Q() const { return Q_; }
  const Eigen::VectorXd& b() const { return b_; }
  /// The handles turn by turning + flux n, one row a loop of dual_loops.
  const Eigen::MatrixXd& flux() const { return flux_; }
  const Eigen::VectorXd& turning() const { return turning_; }

 private:
  Eigen::MatrixXd fluxes(const Eigen::MatrixXd& functions) const;
  void respond(const std::vector<int>& places, const std::function<void()>& report);

  const Net& net_;
  const double unit_;
  Laplace laplace_;
  const std::vector<std::vector<int>> loops_;
  int total_ = 0;
  double constant_ = 0;
  Eigen::VectorXd weights_, u0_, response0_, b_, turning_;
  Eigen::MatrixXd Q_, flux_;
  std::vector<Eigen::VectorXd> response_, flux_of_;  // #V, L^-1 W G and the flux of G; empty until it is a candidate
};

}  // namespace holomorph::tiling
