#include "tiling/greens/jacobian.h"

#include <Eigen/LU>

namespace holomorph::tiling {

Jacobian::Jacobian(const PoleBasis& basis) : basis_(basis) {
  const auto& theta = basis.structure().differentials;
  MatrixXcd both(theta.rows(), 2 * theta.cols());
  both << theta, theta.conjugate();
  // theta_j and conj(theta_j) are a basis of the complex classes: X = theta c + conj(theta) t.
  split_ = both.inverse();
  inverse_wedge_ = basis.structure().topology.pairing.cast<double>().inverse();
  const auto& triangles = basis.surface().triangles;
  first_triangle_.assign(basis.surface().vertex_count, -1);
  for (int t = static_cast<int>(triangles.size()) - 1; t >= 0; --t) {
    for (const int v : triangles[t]) first_triangle_[v] = t;
  }
}

std::vector<int> Jacobian::triangles_at(const std::vector<int>& vertices) const {
  std::vector<int> triangles;
  for (const int v : vertices) triangles.push_back(first_triangle_[v]);
  return triangles;
}

MatrixXcd Jacobian::abel_jacobi_derivatives(const std::vector<int>& triangles) const {
  return inverse_wedge_ * basis_.derivatives(triangles).transpose();
}

// X loses r Re(D dz), D the derivative of the Abel-Jacobi map. The pairing of a class with theta_j sees its (0,1) part
// alone, and for J^-1 h(dz) it is theta_j(dz). So t depends on dz, not on its conjugate, and the real part of D is
// enough.
MatrixXcd Jacobian::tau(const std::vector<int>& triangles) const {
  const auto g = basis_.form_count();
  return -(split_.bottomRows(g) * abel_jacobi_derivatives(triangles).real().cast<Complex>());
}

MatrixXcd weighted_gram(const MatrixXcd& theta, const ArrayXd& density) {
  const ArrayXd weight = 1 / ((density + uv::kDensityFloor * density.mean()) * static_cast<double>(density.size()));
  return theta.transpose() * weight.matrix().cast<Complex>().asDiagonal() * theta.conjugate();
}

}  // namespace holomorph::tiling
