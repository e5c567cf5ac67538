// The Abel-Jacobi map of the vertices of a closed surface with handles, exact on its triangulation.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "linear/dense.h"
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

/// C(p), real and modulo integers: the differential with residue r at p and -r at q, its v single-valued, has the
/// periods -r (C(p) - C(q)). It is minus the Abel-Jacobi map, and forms::harmonic_part without its solves: C = G^-1 P,
/// P_j(p) = <u_s, h_j> over the faces outside the star of p - b_u . (h_j measured from p), where the class of u_s runs
/// along a dual path to triangle 0, over which *h_j integrates to a dual potential.
class AbelJacobi {
 public:
  /// @pre the basis outlives this. Cost: 2g numbers per triangle.
  AbelJacobi(const PoleBasis& basis, Execution& execution);

  /// 2g numbers, found once for each vertex; threads may ask side by side.
  /// @param vertex whose star is free (mesh::has_free_star)
  /// @throws SolverError where the rounding of fluxes may change it by more than forms::kEnergyError
  const VectorXd& at(int vertex) const;

 private:
  VectorXd computed(int vertex) const;
  Eigen::RowVectorXd along(mesh::HalfedgeHandle h) const;
  double rounding_of(double weight) const;

  const PoleBasis& basis_;
  linear::Cholesky<MatrixXd> gram_;
  forms::RowMajorMatrix dual_potentials_;  // #T x 2g: the fluxes of h_j along a dual path to triangle 0
  std::vector<double> rounding_;           // #T: of these
  double largest_ = 0, inverse_ = 0;       // values of functions; the norm of G^-1
  mutable std::mutex mutex_;
  mutable std::unordered_map<int, VectorXd> found_;
};

/// `value` plus the integers that bring it nearest to `near`.
VectorXd nearest_representative(const VectorXd& value, const VectorXd& near);

}  // namespace holomorph::tiling
