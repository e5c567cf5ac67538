#include "solver/direct/direct_solver.h"

#include <algorithm>
#include <cassert>
#include <sstream>

#include "solver/direct/sparse_cholesky.h"
#include "solver/laplace_solver.h"

namespace holomorph::solver {
namespace {

// Numbers in the right-hand sides of one back-substitution, about 0.05 s of work: cancelling is asked for in between.
constexpr Eigen::Index kBlockEntries = 500'000;
// Right-hand sides of a block, at least: with one at a time the factor is read for each of them.
constexpr Eigen::Index kLeastBlock = 4;
// Refinement goes on to this residual while it helps; the promise is kResidual.
constexpr double kRefined = 1e-13;
constexpr int kMostRefinements = 4;

// L without the row and column of one vertex, lower triangle: positive definite for a connected surface.
Laplacian::Matrix pinned(const Eigen::Map<const Laplacian::Matrix>& L, Eigen::Index vertex, Execution& execution) {
  const auto n = L.rows() - 1;
  Laplacian::Matrix lower(n, n);
  lower.reserve(L.nonZeros() / 2 + n);
  for (Eigen::Index i = 0; i < n; ++i) {
    execution.step(i, n, 0.0, 0.1);
    const Eigen::Index column = i < vertex ? i : i + 1;
    lower.startVec(i);
    for (Eigen::Map<const Laplacian::Matrix>::InnerIterator it(L, column); it; ++it) {
      if (it.row() >= column && it.row() != vertex) lower.insertBack(it.row() - (it.row() > vertex), i) = it.value();
    }
  }
  lower.finalize();
  return lower;
}

class DirectSolver final : public LaplaceSolver {
 public:
  // If there are fixed vertices, one of them is pinned: then both problems lack the same unknown.
  DirectSolver(Laplacian&& L, std::vector<int> fixed, Execution& execution)
      : L_(std::move(L)), fixed_(std::move(fixed)) {
    pin_ = fixed_.empty() ? L_.size() - 1 : fixed_.back();
    std::vector<char> last(fixed_.empty() ? 0 : L_.size() - 1);
    for (const int v : fixed_) {
      if (v != pin_) last[v] = 1;
    }
    factor_.compute(pinned(L_.matrix(), pin_, execution), std::move(last));
    execution.report(0.8);
  }

  Solution solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) override {
    Solution X(B.rows(), B.cols());
    const Eigen::Index block = direct_block(B.rows());
    for (Eigen::Index first = 0, width = 1; first < B.cols(); first += width) {
      condition_ = conditions[first];
      assert(condition_ == Condition::natural || !fixed_.empty());
      width = 1;
      // Consecutive columns under one condition share a back-substitution.
      while (width < std::min(block, B.cols() - first) && conditions[first + width] == condition_) ++width;
      done_ = 0.8 + 0.2 * static_cast<double>(first) / static_cast<double>(B.cols());
      X.middleCols(first, width) = solve_block(B.middleCols(first, width), execution);
    }
    return X;
  }

  Solution precondition(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution&) override {
    Solution X(B.rows(), B.cols());
    for (Eigen::Index k = 0; k < B.cols(); ++k) {
      condition_ = conditions[k];
      X.col(k) = apply(B.col(k));
    }
    return X;
  }

  std::string name() const override { return "direct: " + SparseCholesky::name(); }

 private:
  Eigen::MatrixXd solve_block(Eigen::MatrixXd B, Execution& execution) {
    execution.report(done_);
    if (condition_ == Condition::dirichlet) B(fixed_, Eigen::all).setZero();
    Refined x = refined(B, execution);
    if (!(x.size <= kResidual) && condition_ == Condition::natural) {
      // A right-hand side that is rounding alone need not sum to 0, and nothing solves for what it sums to.
      B.rowwise() -= B.colwise().mean().eval();
      x = refined(B, execution);
    }
    if (!(x.size <= kResidual) && !is_rounding(x.R, x.X, B)) {
      std::ostringstream message;
      message << "the direct solver reached a relative residual of " << x.size << " instead of " << kResidual
              << ", on a system of " << B.rows() << " unknowns";
      throw SolverError(message.str());
    }
    residual_ = std::max(residual_, x.size);
    return std::move(x.X);
  }

  struct Refined {
    Eigen::MatrixXd X, R;  // R = B - L X
    double size;           // norm of R, relative to B
  };

  Refined refined(const Eigen::MatrixXd& B, Execution& execution) {
    Refined x{apply(B), {}, 0};
    x.R = residuals(x.X, B);
    x.size = relative(x.R, B);
    for (int step = 0; x.size > kRefined && step < kMostRefinements; ++step) {
      execution.report(done_);
      Refined better{x.X + apply(x.R), {}, 0};
      better.R = residuals(better.X, B);
      better.size = relative(better.R, B);
      // Rounding is reached: the better of the two is kept.
      if (!(better.size < x.size)) break;
      x = std::move(better);
      iterations_ = std::max(iterations_, step + 1);
    }
    return x;
  }

  // The solution that is 0 at the pinned vertex, or at all fixed vertices.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& B) {
    const auto before = pin_, after = B.rows() - 1 - pin_;
    Eigen::MatrixXd others(B.rows() - 1, B.cols());
    others << B.topRows(before), B.bottomRows(after);
    others = condition_ == Condition::dirichlet ? factor_.solve_fixed(others) : factor_.solve(others);
    Eigen::MatrixXd X(B.rows(), B.cols());
    X << others.topRows(before), Eigen::RowVectorXd::Zero(B.cols()), others.bottomRows(after);
    return X;
  }

  Eigen::MatrixXd residuals(const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) const {
    Eigen::MatrixXd R = B - L_.matrix() * X;
    if (condition_ == Condition::dirichlet) R(fixed_, Eigen::all).setZero();
    return R;
  }

  // Among slivers, weights are so large that b - L x cannot be computed to kResidual |b|.
  bool is_rounding(const Eigen::MatrixXd& R, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) const {
    const Eigen::MatrixXd terms = L_.matrix().cwiseAbs() * X.cwiseAbs() + B.cwiseAbs();
    return (R.colwise().norm().array() <= kRoundingOfTerms * terms.colwise().norm().array()).all();
  }

  static double relative(const Eigen::MatrixXd& R, const Eigen::MatrixXd& B) {
    return largest_relative<Eigen::RowVectorXd>(R.colwise().norm(), B.colwise().norm());
  }

  Laplacian L_;
  std::vector<int> fixed_;
  Eigen::Index pin_ = 0;
  SparseCholesky factor_;
  Condition condition_ = Condition::natural;  // in the solve that runs
  double done_ = 0;                           // for the progress function
};

}  // namespace

Eigen::Index direct_block(Eigen::Index unknowns) {
  return std::max(kLeastBlock, kBlockEntries / std::max<Eigen::Index>(unknowns, 1));
}

std::unique_ptr<LaplaceSolver> make_direct_solver(Laplacian&& L, std::vector<int> fixed, Execution& execution) {
  return std::make_unique<DirectSolver>(std::move(L), std::move(fixed), execution);
}

}  // namespace holomorph::solver
