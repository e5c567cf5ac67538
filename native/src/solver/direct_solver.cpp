#include <Eigen/SparseCholesky>
#include <algorithm>
#include <sstream>

#include "solver/laplace_solver.h"
#include "solver/sparse_cholesky.h"

namespace holomorph::solver {
namespace {

// Numbers in the right-hand sides of one back-substitution, about 0.05 s of work: the progress function is asked
// between.
constexpr Eigen::Index kBlockEntries = 500'000;
// Refinement goes on to this residual while it helps; the promise is kResidual.
constexpr double kGoal = 1e-13;
constexpr int kMostRefinements = 4;
// Among slivers, weights are so large that b - L x cannot be computed to kResidual |b|: a solution is also taken where
// the residual is no more than this part of the terms that it is the difference of, a few dozen rounding errors.
constexpr double kRounding = 1e-14;

// L without the row and column of the last vertex, lower triangle: positive definite for a connected surface.
Laplacian pinned(const Laplacian& L, Progress& progress) {
  const auto n = L.rows() - 1;
  Laplacian lower(n, n);
  lower.reserve(L.nonZeros() / 2 + n);
  for (Eigen::Index column = 0; column < n; ++column) {
    progress.step(column, n, 0.0, 0.1);
    lower.startVec(column);
    for (Laplacian::InnerIterator it(L, column); it; ++it) {
      if (it.row() >= column && it.row() < n) lower.insertBack(it.row(), column) = it.value();
    }
  }
  lower.finalize();
  return lower;
}

class DirectSolver final : public LaplaceSolver {
 public:
  DirectSolver(Laplacian&& L, Progress& progress) {
    L_.swap(L);
    factor_.compute(pinned(L_, progress));
    progress.report(0.8);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B, Progress& progress) override {
    Eigen::MatrixXd X(B.rows(), B.cols());
    const auto block = std::max<Eigen::Index>(1, kBlockEntries / B.rows());
    for (Eigen::Index first = 0; first < B.cols(); first += block) {
      const auto width = std::min(block, B.cols() - first);
      done_ = 0.8 + 0.2 * static_cast<double>(first) / static_cast<double>(B.cols());
      X.middleCols(first, width) = solve_block(B.middleCols(first, width), progress);
    }
    return X;
  }

  std::string name() const override { return "direct: " + SparseCholesky::name(); }

 private:
  Eigen::MatrixXd solve_block(const Eigen::MatrixXd& B, Progress& progress) {
    progress.report(done_);
    Eigen::MatrixXd X = apply(B), R = B - L_ * X;
    double residual = relative(R, B);
    for (int step = 0; residual > kGoal && step < kMostRefinements; ++step) {
      progress.report(done_);
      const Eigen::MatrixXd better = X + apply(R);
      const Eigen::MatrixXd rest = B - L_ * better;
      const double reached = relative(rest, B);
      if (!(reached < residual)) break;
      X = better;
      R = rest;
      residual = reached;
      iterations_ = std::max(iterations_, step + 1);
    }
    if (!(residual <= kResidual) && !is_rounding(R, X, B)) {
      std::ostringstream message;
      message << "the direct solver reached a relative residual of " << residual << " instead of " << kResidual
              << ", on a system of " << B.rows() << " unknowns";
      throw SolverError(message.str());
    }
    residual_ = std::max(residual_, residual);
    return X;
  }

  // The solution that is 0 at the pinned vertex.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& B) {
    const auto n = B.rows() - 1;
    Eigen::MatrixXd X(n + 1, B.cols());
    X.topRows(n) = factor_.solve(B.topRows(n));
    X.row(n).setZero();
    return X;
  }

  bool is_rounding(const Eigen::MatrixXd& R, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) const {
    const Eigen::MatrixXd terms = L_.cwiseAbs() * X.cwiseAbs() + B.cwiseAbs();
    return (R.colwise().norm().array() <= kRounding * terms.colwise().norm().array()).all();
  }

  static double relative(const Eigen::MatrixXd& R, const Eigen::MatrixXd& B) {
    double worst = 0;
    for (Eigen::Index c = 0; c < B.cols(); ++c) {
      const double norm = B.col(c).norm(), rest = R.col(c).norm();
      // std::max would drop a NaN
      const double ratio = norm > 0 ? rest / norm : rest;
      if (!(ratio <= worst)) worst = ratio;
    }
    return worst;
  }

  Laplacian L_;
  SparseCholesky factor_;
  double done_ = 0;  // for the progress function
};

}  // namespace

std::unique_ptr<LaplaceSolver> make_direct_solver(Laplacian&& L, Progress& progress) {
  return std::make_unique<DirectSolver>(std::move(L), progress);
}

}  // namespace holomorph::solver
