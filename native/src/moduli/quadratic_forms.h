// Positive definite quadratic forms compared with each other.
#pragma once

#include <Eigen/Core>

namespace holomorph::moduli {

/// Logarithms of the least and the greatest ratio x A x^T / x B x^T.
struct LogRatios {
  double least, greatest;
};

/// Compares two forms by their generalised eigenvalues. @pre symmetric. Where A is not positive definite, the least is
/// -infinity.
/// @throws SolverError where B is not positive definite
LogRatios log_ratios(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace holomorph::moduli
