// The interface of the solvers of L x = b, L the cotan Laplacian of a connected surface.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
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

}  // namespace holomorph::solver
