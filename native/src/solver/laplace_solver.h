// The interface behind which every solver of L x = b stands, L the cotan Laplacian of a connected surface.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/execution.h"
#include "solver/laplacian.h"

namespace holomorph::solver {

/// A solver promises |L x - b| <= kResidual |b| for every right-hand side, in the Euclidean norm, or throws.
/// The direct one also takes what rounding allows where weights are large, |L x - b| <= 1e-14 ||L| |x| + |b||.
inline constexpr double kResidual = 1e-10;

/// What multigrid goes on to while that helps. At a single vertex of a fine mesh the form may be a thousand times less
/// harmonic than the residual of the whole right-hand side says.
inline constexpr double kGoal = 1e-12;

/// Which problem is solved. A solver is made for one set of vertices that can be held at 0, mostly those of the
/// boundary.
enum class Condition {
  natural,   ///< L x = b at every vertex: nothing is held, and the flux through the boundary is part of b
  dirichlet  ///< x = 0 at the held vertices, L x = b at the others
};

/// What is solved for: the values of all right-hand sides at a vertex side by side.
using Solution = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class LaplaceSolver {
 public:
  virtual ~LaplaceSolver() = default;

  /// Solves for all right-hand sides at once, each under its own condition.
  /// @param conditions #rhs
  /// @param B #V x #rhs; natural: each column sums to 0; dirichlet: the rows of held vertices are ignored
  /// @return #V x #rhs; natural: each column up to a constant; dirichlet: 0 at the held vertices, exactly
  /// @throws SolverError with the residual reached and the size of the system; Cancelled
  virtual Solution solve(const Eigen::MatrixXd& B, const std::vector<Condition>& conditions, Execution& execution) = 0;
  Solution solve(const Eigen::MatrixXd& B, Condition condition, Execution& execution) {
    return solve(B, std::vector<Condition>(B.cols(), condition), execution);
  }

  /// What was used, e.g. "direct: CHOLMOD supernodal, AMD".
  virtual std::string name() const = 0;

  /// What went otherwise than asked for, one sentence; mostly empty.
  virtual std::string remark() const { return {}; }

  /// Largest relative residual over all right-hand sides so far.
  double residual() const { return residual_; }
  /// Steps of iterative refinement of the direct solver, or iterations of multigrid, at the worst right-hand side.
  int iterations() const { return iterations_; }

 protected:
  double residual_ = 0;
  int iterations_ = 0;
};

/// Sparse Cholesky with one vertex pinned: CHOLMOD where the library was built with it, Eigen's otherwise. CHOLMOD
/// takes the held vertices last, so that one factorisation serves both conditions.
/// @param held vertices, ascending and distinct; none for a closed surface, where dirichlet must not be asked for
/// @throws SolverError if the factorisation fails; Cancelled before or after it
std::unique_ptr<LaplaceSolver> make_direct_solver(Laplacian&& L, std::vector<int> held, Execution& execution);

/// Conjugate gradients for up to 8 right-hand sides at once, preconditioned by algebraic multigrid in single precision
/// inside a correction in double precision: linear time and memory. Takes weights of any signs, fewer iterations
/// without negative ones; where it does not converge, the direct solver takes its place, and the remark says so.
/// The bits of the result do not depend on the number of threads.
/// @param goal relative residual to go on to while that helps, at most kResidual
/// @throws SolverError if the direct solver fails as well; Cancelled
/// Cost: about 0.6 us per vertex and 1.2 us per vertex and 4 right-hand sides on one thread; 0.35 KB per vertex
/// for 4 right-hand sides.
std::unique_ptr<LaplaceSolver> make_multigrid_solver(Laplacian&& L, std::vector<int> held, double goal,
                                                     Execution& execution);

enum class Method { direct, multigrid };

struct Choice {
  Method method;
  std::string reason;  ///< one phrase, e.g. "asked for"
};

/// @param name "auto", "direct" or "multigrid"; "auto" takes the faster one by size alone, so that the bits do not
/// depend on the machine
Choice choose_method(const std::string& name, Eigen::Index unknowns, Eigen::Index right_hand_sides);

/// Estimate of the memory of the direct solver's factor.
double factor_bytes(double unknowns);

/// @param held vertices in any order; out of range: our bug
/// @param goal of multigrid; the direct solver has none
std::unique_ptr<LaplaceSolver> make_solver(Method method, Laplacian&& L, std::vector<int> held, Execution& execution,
                                           double goal = kGoal);

}  // namespace holomorph::solver
