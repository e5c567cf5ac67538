#include "moduli/quadratic_forms.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <string>

#include "base/errors.h"

namespace holomorph::moduli {

using Eigen::MatrixXd;

LogRatios log_ratios(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::LLT<MatrixXd> root(B);
  if (root.info() != Eigen::Success)
    throw SolverError("the energies of " + std::to_string(B.rows()) + " classes are not positive definite");
  // The eigenvalues of L^-1 A L^-T, B = L L^T, are the stationary values of x A x / x B x.
  const MatrixXd half = root.matrixL().solve(A), both = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen((both + both.transpose()) / 2, Eigen::EigenvaluesOnly);
  const auto log = [](double x) { return x > 0 ? std::log(x) : -std::numeric_limits<double>::infinity(); };
  return {log(eigen.eigenvalues().minCoeff()), log(eigen.eigenvalues().maxCoeff())};
}

}  // namespace holomorph::moduli
