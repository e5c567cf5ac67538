// The interface of the solvers of L x = b, L the cotan Laplacian of a connected surface.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"

namespace holomorph::solver {

/// The cotan Laplacian L of a connected surface: symmetric, both triangles stored, positive semi-definite; its kernel
/// is the constants. Stored row by row, which is the same as column by column. Its arrays are on large pages, and moved
/// without a copy, as a sparse matrix of Eigen's (3.4) is not.
struct Laplacian {
  Array<int> starts;      ///< #V + 1, where each row begins, and the end of the last
  Array<int> columns;     ///< ascending in each row, the diagonal among them
  Array<double> weights;  ///< weights of the same entries

  int size() const { return starts.empty() ? 0 : static_cast<int>(starts.size()) - 1; }

  using Matrix = Eigen::SparseMatrix<double>;
  /// The same as a matrix of Eigen's, without a copy.
  Eigen::Map<const Matrix> matrix() const {
    const auto entries = static_cast<Eigen::Index>(columns.size());
    return {size(), size(), entries, starts.data(), columns.data(), weights.data()};
  }
};

/// A solver promises |L x - b| <= kResidual |b| for every right-hand side, in the Euclidean norm, or throws.
/// Where weights are large, the direct solver also accepts what rounding allows, |L x - b| <= 1e-14 ||L| |x| + |b||.
/// That residual may be as large as b, and then says little about x. Forms are refined in that case
/// (forms/refined_solver.h).
inline constexpr double kResidual = 1e-10;

/// Relative residual at which multigrid stops; it stops earlier where no more is gained. The reason: at a single vertex
/// of a fine mesh, a form may be a thousand times less harmonic than the whole residual says.
inline constexpr double kGoal = 1e-12;

/// Which problem is solved. A solver is made for one set of fixed vertices, mostly those of the boundary.
enum class Condition {
  natural,   ///< L x = b at every vertex: nothing is fixed, and the flux through the boundary is part of b
  dirichlet  ///< x = 0 at the fixed vertices, L x = b at the others
};

/// The unknowns: the values of all right-hand sides at a vertex side by side, #V x #rhs.
using Solution = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class LaplaceSolver {
 public:
  virtual ~LaplaceSolver() = default;

  /// Solves for all right-hand sides at once, each under its own condition.
  /// @param conditions #rhs
  /// @param B #V x #rhs; natural: each column sums to 0; dirichlet: the rows of fixed vertices are ignored
  /// @return #V x #rhs; natural: each column up to a constant; dirichlet: 0 at the fixed vertices, exactly
  /// @throws SolverError with the residual reached and the size of the system; Cancelled
  virtual Solution solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) = 0;
  Solution solve(const Eigen::MatrixXd& B, Condition condition, Execution& execution) {
    return solve(B, std::vector<Condition>(B.cols(), condition), execution);
  }

  /// A rough solution, for minimisers that need an approximate inverse of L. The operator is always the same, symmetric
  /// and positive definite (natural: semi-definite). Multigrid runs one V-cycle.
  virtual Solution precondition(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions,
                                Execution& execution) {
    return solve(B, conditions, execution);
  }

  /// Names the method, e.g. "direct: CHOLMOD supernodal, AMD".
  virtual std::string name() const = 0;

  /// What was done differently from what was asked for, in one sentence; usually empty.
  virtual std::string remark() const { return {}; }

  /// Largest relative residual over all right-hand sides so far.
  double residual() const { return residual_; }
  /// Steps of iterative refinement of the direct solver, or iterations of multigrid, at the worst right-hand side.
  int iterations() const { return iterations_; }

 protected:
  double residual_ = 0;
  int iterations_ = 0;
};

// Several right-hand sides side by side: how columns are cut into blocks, quotients of their norms, and progress.

/// The part of the terms of B - L X, |L| |X| + |B|, up to which a residual is rounding: a few dozen rounding errors.
inline constexpr double kRoundingOfTerms = 1e-14;

/// Calls solve(K, begin, end) with a constant K for the columns begin .. end-1: blocks of 8, and at the end one of 4 or
/// 2 where that is enough.
template <class Solve>
void for_column_blocks(Eigen::Index columns, const Solve& solve) {
  const Eigen::Index over = columns % 8, in_eights = columns - (over <= 4 ? over : 0);
  if (in_eights > 0) solve(std::integral_constant<int, 8>(), Eigen::Index{0}, in_eights);
  if (in_eights == columns) return;
  if (over <= 2) {
    solve(std::integral_constant<int, 2>(), in_eights, columns);
  } else {
    solve(std::integral_constant<int, 4>(), in_eights, columns);
  }
}

/// a / b where b > 0, else 0: a right-hand side that is solved exactly stays as it is.
template <int K>
Eigen::Array<double, K, 1> quotient(const Eigen::Array<double, K, 1>& a, const Eigen::Array<double, K, 1>& b) {
  return (b > 0).select(a / b, 0.0);
}

/// The largest relative residual, given norms of residuals and of right-hand sides; NaN where one is.
template <class Norms>
double largest_relative(const Norms& residuals, const Norms& norms) {
  double worst = 0;
  for (Eigen::Index d = 0; d < norms.size(); ++d) {
    const double ratio = norms[d] > 0 ? residuals[d] / norms[d] : residuals[d];
    if (!(ratio <= worst)) worst = ratio;  // std::max would drop a NaN
  }
  return worst;
}

/// Part of the digits down to the relative residual `goal` that are reached, in [0, 1]: how far a solve has come.
inline double part_of_digits(double reached, double goal) {
  return std::clamp(std::log10(reached) / std::log10(goal), 0.0, 1.0);
}

}  // namespace holomorph::solver
