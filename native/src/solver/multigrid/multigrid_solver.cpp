#include "solver/multigrid/multigrid_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/workers.h"
#include "solver/direct/direct_solver.h"
#include "solver/laplace_solver.h"
#include "solver/multigrid/block_solve.h"

namespace holomorph::solver {
namespace {

// The largest size at which a block of 8 right-hand sides fits into 1 MB, and any order will do.
constexpr int kCached = 32'768;
// An entry is far from a row where it is further than this from all entries of the row: another page of memory.
constexpr int kFar = 256;
// An order is scattered where more than this part of the entries is far. A random order has nearly all, an order along
// a curve or by slices a tenth at most.
constexpr double kMostFar = 0.5;
// One chunk of rows in this number is looked at, as all say the same.
constexpr int kSampled = 8;
constexpr double kCycle = 60;  // operations for each unknown and right-hand side

// Entries of row i further than kFar from every entry of row i-1.
int far_entries(const Laplacian& L, int i) {
  const int *const start = L.starts.data(), *const column = L.columns.data();
  int count = 0;
  int before = start[i - 1];
  for (int e = start[i]; e < start[i + 1]; ++e) {
    // columns ascend: of the row before, the last entry that is not beyond this one and the first that is
    while (before < start[i] && column[before] <= column[e]) ++before;
    const bool near_last = before > start[i - 1] && column[e] - column[before - 1] <= kFar;
    const bool near_first = before < start[i] && column[before] - column[e] <= kFar;
    count += !near_last && !near_first;
  }
  return count;
}

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
      Execution::count(kCycle * block.iterations() * static_cast<double>(X.rows() * width));
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

bool is_scattered(const Laplacian& L) {
  if (L.size() <= kCached) return false;
  std::int64_t far = 0, all = 0;
  for (int begin = 0; begin + kChunk <= L.size(); begin += kSampled * kChunk) {
    for (int i = begin + 1; i < begin + kChunk; ++i) {
      far += far_entries(L, i);
      all += L.starts[i + 1] - L.starts[i];
    }
  }
  return static_cast<double>(far) > kMostFar * static_cast<double>(all);
}

std::vector<int> breadth_first_order(const Laplacian& L, Execution& execution) {
  const int n = L.size();
  std::vector<int> order;
  order.reserve(n);
  std::vector<char> seen(n, 0);
  for (int first = 0; first < n; ++first) {
    if (seen[first] != 0) continue;
    seen[first] = 1;
    order.push_back(first);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      if (next % kChunk == 0) execution.report(0);
      const int i = order[next];
      for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) {
        const int j = L.columns[e];
        if (seen[j] == 0) order.push_back(j);
        seen[j] = 1;
      }
    }
  }
  return order;
}

// Row by row of the given matrix in the new order, each entry is appended to the row of the other end: ascending
// without sorting, as the matrix is symmetric.
Laplacian renumbered(const Laplacian& L, const std::vector<int>& order) {
  const int n = L.size();
  std::vector<int> number(n), end(n);
  for (int i = 0; i < n; ++i) number[order[i]] = i;
  Laplacian result{Array<int>(n + 1), Array<int>(L.columns.size()), Array<double>(L.weights.size())};
  result.starts[0] = 0;
  for (int i = 0; i < n; ++i) {
    end[i] = result.starts[i];
    result.starts[i + 1] = end[i] + L.starts[order[i] + 1] - L.starts[order[i]];
  }
  for (int j = 0; j < n; ++j) {
    for (int e = L.starts[order[j]]; e < L.starts[order[j] + 1]; ++e) {
      const int place = end[number[L.columns[e]]]++;
      result.columns[place] = j;
      result.weights[place] = L.weights[e];
    }
  }
  return result;
}

std::unique_ptr<LaplaceSolver> make_multigrid_solver(Laplacian&& L, std::vector<int> fixed, double goal,
                                                     Execution& execution) {
  return std::make_unique<MultigridSolver>(std::move(L), std::move(fixed), goal, execution);
}

}  // namespace holomorph::solver
