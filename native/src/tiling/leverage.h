// How far the (0,1) part of a form follows the poles: what moving a pole can repair.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tiling/landscape.h"

namespace holomorph::tiling {

/// On a closed surface with handles. A closed form with the integer periods X besides its poles is
/// sum_j c_j theta_j + sum_j t_j conj(theta_j), and t is what keeps it from being conformal. Moving a pole of residue
/// r by dz (z along side 0 of its triangle) changes t by r tau dz.
class Leverage {
 public:
  explicit Leverage(const Landscape& landscape);

  /// c, then t, 2g numbers, of the periods X.
  Eigen::VectorXcd split(const Eigen::VectorXcd& X) const { return split_ * X; }
  const Eigen::MatrixXcd& split() const { return split_; }

  /// #forms x #triangles: d Pi / dz in real terms, Pi the Abel-Jacobi map: column k holds J^-1 (h_x - i h_y).
  Eigen::MatrixXcd abel_jacobi_derivatives(const std::vector<int>& triangles) const;
  /// g x #triangles: tau on each.
  Eigen::MatrixXcd tau(const std::vector<int>& triangles) const;

  /// The first triangle at each vertex, which stands for it.
  std::vector<int> triangles_at(const std::vector<int>& vertices) const;

 private:
  const Landscape& landscape_;
  std::vector<int> first_triangle_;  // #V
  Eigen::MatrixXd inverse_wedge_;
  Eigen::MatrixXcd split_;
};

/// The Gram matrix W of conj(theta_j) in the mean of |q / theta_0|^2: the mean of theta_j conj(theta_k) / |theta_0|^2
/// over the samples, theta_0 floored at 1e-4 of its mean square.
Eigen::MatrixXcd weighted_gram(const Eigen::MatrixXcd& theta, const Eigen::ArrayXd& density);

}  // namespace holomorph::tiling
