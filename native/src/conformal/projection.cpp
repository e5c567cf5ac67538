#include "conformal/projection.h"

#include <string>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::conformal {

using Eigen::MatrixXd;

MatrixXd inverse(const MatrixXd& A) { return linear::Cholesky(A).inverse(); }
MatrixXd symmetric(const MatrixXd& A) { return (A + A.transpose()) / 2; }

MatrixXd geometric_mean(const MatrixXd& A, const MatrixXd& B) {
  const linear::Cholesky root(A);
  if (!root.succeeded())
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) + " forms is not positive definite");
  // A # B = L (L^-1 B L^-T)^(1/2) L^T for any L with A = L L^T: the mean is invariant under congruence.
  const MatrixXd L = root.lower(), inner = root.solve_lower(root.solve_lower(B).transpose());  // L^-1 B L^-T
  const auto middle = linear::square_root(symmetric(inner));
  if (!middle) {
    throw SolverError("the Gram matrix of " + std::to_string(A.rows()) +
                      " forms is too badly conditioned to be projected");
  }
  return symmetric(L * *middle * L.transpose());
}

ProjectedStar projected_star(const MatrixXd& G_N, const MatrixXd& G_D, const MatrixXd& W) {
  ProjectedStar result;
  result.lower = symmetric(W * inverse(G_D) * W.transpose());
  result.natural_gram = geometric_mean(G_N, result.lower);
  result.dirichlet_gram = symmetric(W.transpose() * inverse(result.natural_gram) * W);
  // C W^T = G, and G is symmetric: C^T = W^-1 G.
  result.star = linear::solve(W, result.natural_gram).transpose();
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
