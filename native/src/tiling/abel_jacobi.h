// The Abel-Jacobi map of the vertices of a closed surface with handles, exact on its triangulation.
#pragma once

#include <Eigen/Cholesky>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "tiling/landscape.h"

namespace holomorph::tiling {

/// C(p), real and modulo integers: the differential with residue r at p and -r at q, its v single-valued, has the
/// periods -r (C(p) - C(q)). It is minus the Abel-Jacobi map, and forms::harmonic_part without its solves: C = G^-1 P,
/// P_j(p) = <u_s, h_j> over the faces outside the star of p - b_u . (h_j measured from p), where the class of u_s runs
/// along a dual path to triangle 0, over which *h_j integrates to a dual potential.
class AbelJacobi {
 public:
  /// The landscape outlives this. Cost: 2g numbers per triangle.
  AbelJacobi(const Landscape& landscape, Execution& execution);

  /// 2g numbers, found once for each vertex; threads may ask side by side.
  /// @param vertex whose star is free (mesh::has_free_star)
  /// @throws SolverError where the rounding of fluxes may change it by more than forms::kEnergyError
  const Eigen::VectorXd& at(int vertex) const;

 private:
  Eigen::VectorXd computed(int vertex) const;
  Eigen::RowVectorXd along(mesh::HalfedgeHandle h) const;
  double rounding_of(double weight) const;

  const Landscape& landscape_;
  Eigen::LLT<Eigen::MatrixXd> gram_;
  forms::RowMajorMatrix dual_potentials_;  // #T x 2g: the fluxes of h_j along a dual path to triangle 0
  std::vector<double> rounding_;           // #T: of these
  double largest_ = 0, inverse_ = 0;       // values of functions; the norm of G^-1
  mutable std::mutex mutex_;
  mutable std::unordered_map<int, Eigen::VectorXd> found_;
};

/// `value` plus the integers that bring it nearest to `near`.
Eigen::VectorXd nearest_representative(const Eigen::VectorXd& value, const Eigen::VectorXd& near);

}  // namespace holomorph::tiling
