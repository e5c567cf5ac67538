#include "conformal/projection.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <string>

#include "base/errors.h"

namespace holomorph::conformal {

using Eigen::MatrixXd;

MatrixXd inverse(const MatrixXd& A) { return A.llt().solve(MatrixXd::Identity(A.rows(), A.cols())); }
MatrixXd symmetric(const MatrixXd& A) { return (A + A.transpose()) / 2; }

MatrixXd geometric_mean(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::LLT<MatrixXd> root(A);
  if (root.info() != Eigen::Success)
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) + " forms is not positive definite");
  // A # B = L (L^-1 B L^-T)^(1/2) L^T for any L with A = L L^T: the mean is invariant under congruence.
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

ProjectedStar projected_star(const MatrixXd& G_N, const MatrixXd& G_D, const MatrixXd& W) {
  ProjectedStar result;
  result.lower = symmetric(W * inverse(G_D) * W.transpose());
  result.natural_gram = geometric_mean(G_N, result.lower);
  result.dirichlet_gram = symmetric(W.transpose() * inverse(result.natural_gram) * W);
  const Eigen::PartialPivLU<MatrixXd> factors(W);  // C W^T = G, and G is symmetric: C^T = W^-1 G
  result.star = factors.solve(result.natural_gram).transpose();
  return result;
}

Eigen::MatrixXcd period_matrix(const MatrixXd& G) {
  const auto g = G.rows() / 2;
  // Both are symmetric for a projected Gram matrix, up to the rounding that is removed here.
  const MatrixXd imaginary = symmetric(inverse(G.bottomRightCorner(g, g)));
  const MatrixXd real = symmetric(-G.topRightCorner(g, g) * imaginary);
  return real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary.cast<std::complex<double>>();
}

}  // namespace holomorph::conformal
