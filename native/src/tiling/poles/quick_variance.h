// How uneven the density of a form is, for a search that asks often: uv::LogVariance in single precision.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "tiling/notation.h"
#include "uv/log_variance.h"

namespace holomorph::tiling {

/// Variance of log(q / mean q + floor), q = |A|^2, to some 1e-6 of it.
class QuickVariance {
 public:
  /// @param parts #samples x #unknowns: A are their combinations
  QuickVariance(const Eigen::MatrixXcf& parts, uv::Coefficients kind);

  void set_floor(double floor) { floor_ = static_cast<float>(floor); }
  double operator()(const VectorXd& x, VectorXd& gradient) const;

  /// Minimises it from `x`, whose scale is free; the first step knows the curvature there.
  /// @param tick called for each value; it may throw
  void descend(VectorXd& x, int most_steps, const std::function<void()>& tick) const;

  /// q on the samples.
  ArrayXd density(const VectorXd& x) const;

 private:
  MatrixXd inverse_curvature(const VectorXd& x) const;

  Eigen::MatrixXf M_;  // real parts of A above imaginary ones, of each unknown
  float floor_ = 0;
};

}  // namespace holomorph::tiling
