#include "conformal/holomorphic_basis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "base/errors.h"

namespace holomorph::conformal {
namespace {

using Eigen::MatrixXd;

MatrixXd inverse(const MatrixXd& A) { return A.llt().solve(MatrixXd::Identity(A.rows(), A.cols())); }
MatrixXd symmetric(const MatrixXd& A) { return (A + A.transpose()) / 2; }

}  // namespace

MatrixXd geometric_mean(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::LLT<MatrixXd> root(A);
  if (root.info() != Eigen::Success)
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) + " forms is not positive definite");
  const MatrixXd L = root.matrixL();
  const MatrixXd half = L.triangularView<Eigen::Lower>().solve(B);
  const MatrixXd inner = L.triangularView<Eigen::Lower>().solve(half.transpose());  // L^-1 B L^-T
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(symmetric(inner));
  if (eigen.info() != Eigen::Success || !(eigen.eigenvalues().minCoeff() > 0)) {
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) +
                      " forms is too badly conditioned to be projected");
  }
  return symmetric(L * eigen.operatorSqrt() * L.transpose());
}

HolomorphicBasis holomorphic_basis(const MatrixXd& G_zeta, const topology::CanonicalBasis& basis) {
  const auto g = G_zeta.rows() / 2;
  const MatrixXd S = basis.classes.cast<double>();
  const MatrixXd G = symmetric(S * G_zeta * S.transpose());  // of alpha_1..alpha_g, beta_1..beta_g
  MatrixXd J = MatrixXd::Zero(2 * g, 2 * g);
  J.topRightCorner(g, g).setIdentity();
  J.bottomLeftCorner(g, g) = -MatrixXd::Identity(g, g);
  // The polar projection C# = C (-C^2)^(-1/2) is the geometric mean of the two sides of G_exact <= G, >= J^T G^-1 J.
  const MatrixXd projected = geometric_mean(G, J.transpose() * inverse(G) * J);

  HolomorphicBasis result;
  const MatrixXd imaginary = symmetric(inverse(projected.bottomRightCorner(g, g)));
  const MatrixXd real = symmetric(-projected.topRightCorner(g, g) * imaginary);
  result.period_matrix =
      real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary.cast<std::complex<double>>();
  Eigen::MatrixXcd canonical(2 * g, g);  // int_{a_i} theta_j = delta_ij, int_{b_i} theta_j = Omega_ij
  canonical << Eigen::MatrixXcd::Identity(g, g), result.period_matrix;
  result.periods = S.transpose() * canonical;  // zeta = R^-1 (a, b), and R^-1 = S^T
  const MatrixXd G_ab = G.topRightCorner(g, g);
  result.lower = symmetric(inverse(G.bottomRightCorner(g, g)));
  result.upper = symmetric(G.topLeftCorner(g, g) - G_ab * result.lower * G_ab.transpose());
  return result;
}

}  // namespace holomorph::conformal
