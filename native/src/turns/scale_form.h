// The log scale of a flat metric with cones, as a quadratic form in the cones.
#pragma once

#include <functional>
#include <vector>

#include "turns/laplace.h"
#include "turns/net.h"

namespace holomorph::turns {

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

}  // namespace holomorph::turns
