#include <algorithm>
#include <cmath>

#include "base/page_allocator.h"
#include "solver/block_solve.h"
#include "solver/renumbering.h"
#include "solver/weight_rests.h"

namespace holomorph::solver {
namespace {

class MultigridSolver final : public LaplaceSolver {
 public:
  MultigridSolver(Laplacian&& L, std::vector<int> held, double goal, Execution& execution)
      : L_(std::move(L)), held_(std::move(held)), goal_(goal) {
    renumber(execution);
    try {
      make_hierarchy(std::move(L_), held_, execution.workers(), execution, hierarchy_);
    } catch (const SolverError& error) {
      fall_back(error, execution);
    }
    execution.report(kSetUp);
  }

  Solution solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) override {
    if (order_.empty()) return solve_in_order(B, conditions, execution);
    const Solution solution = solve_in_order(B(order_, Eigen::all), conditions, execution);
    Solution X(B.rows(), B.cols());
    X(order_, Eigen::all) = solution;
    return X;
  }

  std::string name() const override {
    if (direct_) return direct_->name();
    return "multigrid: conjugate gradients, " + std::to_string(hierarchy_.levels.size()) + " levels";
  }

  std::string remark() const override { return remark_; }

 private:
  static constexpr double kSetUp = 0.3;  // of the whole work, for the progress function

  // From here on vertices have the numbers of the solver's own order, where the given one is bad.
  void renumber(Execution& execution) {
    if (!is_scattered(L_, execution.workers())) return;
    order_ = breadth_first_order(L_, execution);
    L_ = renumbered(L_, order_);
    std::vector<int> number(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) number[order_[i]] = static_cast<int>(i);
    for (int& v : held_) v = number[v];
    std::sort(held_.begin(), held_.end());
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
    remark_ = std::string("the direct solver took over: ") + error.what();
    L_ = laplacian_of(hierarchy_.levels[0], hierarchy_.rests);
    hierarchy_ = {};
    direct_ = make_direct_solver(std::move(L_), held_, execution);
  }

  // Blocks of 8, and at the end one of 4 or 2 where that is enough.
  Solution solve_by_multigrid(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                              Execution& execution) {
    Solution X(B.rows(), B.cols());
    advise_large_pages(X.data(), X.size() * sizeof(double));
    const Eigen::Index rest = B.cols() % 8, in_eights = B.cols() - (rest <= 4 ? rest : 0);
    Reached reached;
    solve_blocks<8>(B, conditions, 0, in_eights, X, reached, execution);
    if (rest <= 2) {
      solve_blocks<2>(B, conditions, in_eights, B.cols(), X, reached, execution);
    } else {
      solve_blocks<4>(B, conditions, in_eights, B.cols(), X, reached, execution);
    }
    iterations_ = std::max(iterations_, reached.iterations);
    residual_ = std::max(residual_, reached.residual);
    return X;
  }

  struct Reached {
    int iterations = 0;
    double residual = 0;
  };

  template <int K>
  void solve_blocks(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Eigen::Index begin,
                    Eigen::Index end, Solution& X, Reached& reached, Execution& execution) {
    if (begin == end) return;
    BlockSolve<K> block(hierarchy_, goal_, execution.workers());
    for (Eigen::Index first = begin; first < end; first += K) {
      const auto width = static_cast<int>(std::min<Eigen::Index>(K, end - first));
      block.solve(B, conditions, first, width, X, [&](double residual) {
        const double digits = std::clamp(std::log10(residual) / std::log10(kResidual), 0.0, 1.0);
        const double columns = static_cast<double>(first) + digits * width;
        execution.report(kSetUp + (1 - kSetUp) * columns / static_cast<double>(B.cols()));
      });
      reached.iterations = std::max(reached.iterations, block.iterations());
      reached.residual = std::max(reached.residual, block.residual());
    }
  }

  Laplacian L_;             // until the hierarchy takes it apart
  std::vector<int> order_;  // the given number of each of the solver's, empty where these are the same
  std::vector<int> held_;   // in the solver's order
  const double goal_;
  Hierarchy hierarchy_;
  std::unique_ptr<LaplaceSolver> direct_;
  std::string remark_;
};

}  // namespace

std::unique_ptr<LaplaceSolver> make_multigrid_solver(Laplacian&& L, std::vector<int> held, double goal,
                                                     Execution& execution) {
  return std::make_unique<MultigridSolver>(std::move(L), std::move(held), goal, execution);
}

}  // namespace holomorph::solver
