// The interface behind which every solver of L x = b stands, L the cotan Laplacian of a connected surface.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>

#include "base/progress.h"

namespace holomorph::solver {

/// Symmetric, both triangles stored, positive semi-definite; its kernel is the constants.
using Laplacian = Eigen::SparseMatrix<double>;

/// A solver promises |L x - b| <= kResidual |b| for every right-hand side, in the Euclidean norm, or throws.
inline constexpr double kResidual = 1e-10;

class LaplaceSolver {
 public:
  virtual ~LaplaceSolver() = default;

  /// Solves for all right-hand sides at once.
  /// @param B #V x #rhs, each column summing to 0
  /// @return #V x #rhs, each column up to a constant
  /// @throws SolverError with the residual reached and the size of the system; Cancelled
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& B, Progress& progress) = 0;

  /// What was used, e.g. "direct: CHOLMOD supernodal, AMD".
  virtual std::string name() const = 0;

  /// Largest relative residual over all right-hand sides so far.
  double residual() const { return residual_; }
  /// Steps of iterative refinement, or iterations, at the worst right-hand side.
  int iterations() const { return iterations_; }

 protected:
  double residual_ = 0;
  int iterations_ = 0;
};

/// Sparse Cholesky with one vertex pinned: CHOLMOD where the library was built with it, Eigen's otherwise.
/// @throws SolverError if the factorisation fails; Cancelled before or after it
std::unique_ptr<LaplaceSolver> make_direct_solver(Laplacian L, Progress& progress);

}  // namespace holomorph::solver
