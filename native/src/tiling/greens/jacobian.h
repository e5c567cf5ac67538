// The Jacobian of the Abel-Jacobi map: how the (0,1) part of a form follows its poles.
#pragma once

#include <vector>

#include "tiling/greens/pole_basis.h"

namespace holomorph::tiling {

/// The Jacobian on a closed surface with handles. A closed form with the integer periods X besides its poles is sum_j
/// c_j theta_j + sum_j t_j conj(theta_j). It is conformal if t = 0. Moving a pole of residue r by dz (z along side 0 of
/// its triangle) changes t by r tau dz.
class Jacobian {
 public:
  /// @pre the basis outlives this
  explicit Jacobian(const PoleBasis& basis);

  /// 2g x 2g: takes the periods X to c and t.
  const MatrixXcd& split() const { return split_; }

  /// #forms x #triangles: d Pi / dz in real terms, Pi the Abel-Jacobi map: column k holds J^-1 (h_x - i h_y).
  MatrixXcd abel_jacobi_derivatives(const std::vector<int>& triangles) const;
  /// g x #triangles: tau on each.
  MatrixXcd tau(const std::vector<int>& triangles) const;

  /// Returns the first triangle at each vertex, which stands for the vertex.
  std::vector<int> triangles_at(const std::vector<int>& vertices) const;

 private:
  const PoleBasis& basis_;
  std::vector<int> first_triangle_;  // #V
  MatrixXd inverse_wedge_;
  MatrixXcd split_;
};

/// Computes the Gram matrix W of conj(theta_j) in the mean of |q / theta_0|^2: the mean of theta_j conj(theta_k) /
/// |theta_0|^2 over the samples, theta_0 floored at 1e-4 of its mean square.
MatrixXcd weighted_gram(const MatrixXcd& theta, const ArrayXd& density);

}  // namespace holomorph::tiling
