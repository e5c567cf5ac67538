#include "solver/multigrid/multigrid_solver.h"

#include <algorithm>
#include <cmath>

#include "solver/column_blocks.h"
#include "solver/direct/direct_solver.h"
#include "solver/multigrid/block_solve.h"
#include "solver/multigrid/vertex_order.h"

namespace holomorph::solver {
namespace {

class MultigridSolver final : public LaplaceSolver {
 public:
  MultigridSolver(Laplacian&& L, std::vector<int> fixed, double goal, Execution& execution)
      : L_(std::move(L)), fixed_(std::move(fixed)), goal_(goal) {
    renumber(execution);
    try {
      hierarchy_ = make_hierarchy(L_, fixed_, execution);
    } catch (const SolverError& error) {
      fall_back(error, execution);
    }
    execution.report(kSetUp);
  }

  Solution solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) override {
    return in_order(B, [&](const Eigen::MatrixXd& ordered) { return solve_in_order(ordered, conditions, execution); });
  }

  Solution precondition(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                        Execution& execution) override {
    return in_order(B, [&](const Eigen::MatrixXd& ordered) -> Solution {
      if (direct_) return direct_->precondition(ordered, conditions, execution);
      Solution X(B.rows(), B.cols());
      for_blocks(B.cols(), execution.workers(), [&](auto& block, Eigen::Index first, int width) {
        block.run_cycle(ordered, conditions, first, width, X);
      });
      return X;
    });
  }

  std::string name() const override {
    if (direct_) return direct_->name();
    return "multigrid: conjugate gradients, " + std::to_string(hierarchy_.levels.size()) + " levels";
  }

  std::string remark() const override { return remark_; }

 private:
  static constexpr double kSetUp = 0.3;  // part of the whole work, for the progress function

  // Renumbers the vertices breadth first, if the given order is scattered.
  void renumber(Execution& execution) {
    if (!is_scattered(L_)) return;
    order_ = breadth_first_order(L_, execution);
    L_ = renumbered(L_, order_);
    std::vector<int> number(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) number[order_[i]] = static_cast<int>(i);
    for (int& v : fixed_) v = number[v];
    std::sort(fixed_.begin(), fixed_.end());
  }

  // Applies `compute` to the right-hand sides in the solver's order, and returns the result in the given order.
  template <class Compute>
  Solution in_order(const Eigen::MatrixXd& B, const Compute& compute) {
    if (order_.empty()) return compute(B);
    const Solution solution = compute(B(order_, Eigen::all));
    Solution X(B.rows(), B.cols());
    X(order_, Eigen::all) = solution;
    return X;
  }

  // body(block, first, width) for as many columns at a time as go into one block.
  template <class Body>
  void for_blocks(Eigen::Index columns, Workers& workers, const Body& body) {
    for_column_blocks(columns, [&](auto width_of_block, Eigen::Index begin, Eigen::Index end) {
      constexpr int K = width_of_block;
      BlockSolve<K> block(L_, hierarchy_, goal_, workers);
      for (Eigen::Index first = begin; first < end; first += K)
        body(block, first, static_cast<int>(std::min<Eigen::Index>(K, end - first)));
    });
  }

  Solution solve_in_order(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) {
    if (!direct_) {
      try {
        return solve_by_multigrid(B, conditions, execution);
      } catch (const SolverError& error) {
        fall_back(error, execution);
      }
    }
    Solution X = direct_->solve(B, conditions, execution);
    residual_ = std::max(residual_, direct_->residual());
    iterations_ = direct_->iterations();
    return X;
  }

  void fall_back(const SolverError& error, Execution& execution) {
    // The direct solver takes the Laplacian. The hierarchy is dropped first, since both need much memory.
    remark_ = std::string("the direct solver took over: ") + error.what();
    hierarchy_ = {};
    direct_ = make_direct_solver(std::move(L_), fixed_, execution);
  }

  Solution solve_by_multigrid(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                              Execution& execution) {
    Solution X(B.rows(), B.cols());
    advise_large_pages(X.data(), X.size() * sizeof(double));
    int iterations = 0;
    double residual = 0;
    for_blocks(B.cols(), execution.workers(), [&](auto& block, Eigen::Index first, int width) {
      block.solve(B, conditions, first, width, X, [&](double reached) {
        const double columns = static_cast<double>(first) + part_of_digits(reached, kResidual) * width;
        execution.report(kSetUp + (1 - kSetUp) * columns / static_cast<double>(B.cols()));
      });
      iterations = std::max(iterations, block.iterations());
      residual = std::max(residual, block.residual());
    });
    iterations_ = std::max(iterations_, iterations);
    residual_ = std::max(residual_, residual);
    return X;
  }

  Laplacian L_;             // in the solver's order, until the direct solver takes it
  std::vector<int> order_;  // the given number of each of the solver's, empty where these are the same
  std::vector<int> fixed_;  // in the solver's order
  const double goal_;
  Hierarchy hierarchy_;
  std::unique_ptr<LaplaceSolver> direct_;
  std::string remark_;
};

}  // namespace

std::unique_ptr<LaplaceSolver> make_multigrid_solver(Laplacian&& L, std::vector<int> fixed, double goal,
                                                     Execution& execution) {
  return std::make_unique<MultigridSolver>(std::move(L), std::move(fixed), goal, execution);
}

}  // namespace holomorph::solver
