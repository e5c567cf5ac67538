#include "conformal/holomorphic_basis.h"

namespace holomorph::conformal {

using Eigen::MatrixXd;

HolomorphicBasis holomorphic_basis(const MatrixXd& G_zeta, const topology::CanonicalBasis& basis) {
  const auto g = G_zeta.rows() / 2;
  const MatrixXd S = basis.classes.cast<double>();
  const MatrixXd G = symmetric(S * G_zeta * S.transpose());  // of alpha_1..alpha_g, beta_1..beta_g
  MatrixXd J = MatrixXd::Zero(2 * g, 2 * g);
  J.topRightCorner(g, g).setIdentity();
  J.bottomLeftCorner(g, g) = -MatrixXd::Identity(g, g);
  const MatrixXd projected = projected_star(G, G, J).natural_gram;

  HolomorphicBasis result;
  result.period_matrix = period_matrix(projected);
  Eigen::MatrixXcd canonical(2 * g, g);  // int_{a_i} theta_j = delta_ij, int_{b_i} theta_j = Omega_ij
  canonical << Eigen::MatrixXcd::Identity(g, g), result.period_matrix;
  result.periods = S.transpose() * canonical;  // zeta = R^-1 (a, b), and R^-1 = S^T
  const PeriodBounds bounds = period_bounds(G);
  result.lower = bounds.lower;
  result.upper = bounds.upper;
  return result;
}

}  // namespace holomorph::conformal
