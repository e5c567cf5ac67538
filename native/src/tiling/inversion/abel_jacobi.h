// The Abel-Jacobi map of the vertices of a closed surface with handles, exact on its triangulation.
#pragma once

#include <Eigen/Cholesky>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "tiling/greens/pole_basis.h"

namespace holomorph::tiling {

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
  Eigen::LLT<MatrixXd> gram_;
  forms::RowMajorMatrix dual_potentials_;  // #T x 2g: the fluxes of h_j along a dual path to triangle 0
  std::vector<double> rounding_;           // #T: of these
  double largest_ = 0, inverse_ = 0;       // values of functions; the norm of G^-1
  mutable std::mutex mutex_;
  mutable std::unordered_map<int, VectorXd> found_;
};

/// `value` plus the integers that bring it nearest to `near`.
VectorXd nearest_representative(const VectorXd& value, const VectorXd& near);

}  // namespace holomorph::tiling
