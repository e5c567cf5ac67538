#include "solver/multigrid/coarsest_level.h"

#include <Eigen/Cholesky>

namespace holomorph::solver {
namespace {

Eigen::MatrixXd dense(const SparseRows& A) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(A.size(), A.size());
  for (int i = 0; i < A.size(); ++i) {
    for (const auto [j, weight] : A[i]) {
      const double half = 0.5 * weight;  // from either side, so that the inverse is symmetric
      result(i, j) -= half;
      result(j, i) -= half;
      result(i, i) += half;
      result(j, j) += half;
    }
  }
  return result;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) {
    throw SolverError("the multigrid hierarchy failed: its coarsest matrix, of " + std::to_string(A.rows()) +
                      " unknowns, is not positive semi-definite");
  }
  return factor.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
}

// Adds a multiple of the matrix of ones, which gives the constants, the kernel of A, the mean of all eigenvalues. The
// inverse has that part subtracted again.
Eigen::MatrixXf pseudo_inverse(Eigen::MatrixXd A) {
  const auto n = static_cast<double>(A.rows());
  const double trace = A.trace();
  const double lift = trace > 0 ? trace / n / n : 1.0;
  A.array() += lift;
  return (inverse(A).array() - 1.0 / (lift * n * n)).cast<float>();
}

Eigen::MatrixXf inverse_without_fixed(const Eigen::MatrixXd& A, const Array<char>& fixed) {
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(fixed.size()); ++i) {
    if (fixed[i] == 0) free.push_back(i);
  }
  Eigen::MatrixXf result = Eigen::MatrixXf::Zero(A.rows(), A.cols());
  if (!free.empty()) result(free, free) = inverse(A(free, free)).cast<float>();
  return result;
}

}  // namespace

CoarsestInverse coarsest_inverse(const Operator& coarsest) {
  const Eigen::MatrixXd A = dense(coarsest.A);
  CoarsestInverse result{pseudo_inverse(A), {}};
  if (!coarsest.fixed.empty()) result.dirichlet = inverse_without_fixed(A, coarsest.fixed);
  return result;
}

}  // namespace holomorph::solver
