// Solves the linear systems on one triangulation to the promised accuracy of forms. Solutions are refined where weights
// hide the residuals, and refused where that does not help.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/laplacian.h"
#include "solver/solver_choice.h"

namespace holomorph::forms {

/// Relative errors of forms in the energy norm: the goal of refinement, and the error that is promised. Energies, and
/// with them Gram matrices and bounds, are off by the square.
inline constexpr double kEnergyGoal = 1e-10, kEnergyError = 1e-6;

/// The largest weight that needs no refinement. The rounding of its fluxes keeps errors below kEnergyError, even beside
/// weights of its inverse.
inline constexpr double kStiff = 1e4;

/// Solves L f = b, and refines where weights are larger than kStiff (docs/method/harmonic.md).
class RefinedSolver {
 public:
  /// @param weights #E. @param fixed vertices at which Dirichlet functions are 0
  /// @pre the triangulation and its weights outlive this. @throws SolverError, Cancelled
  RefinedSolver(const mesh::HalfEdges& half_edges, std::span<const double> weights, std::vector<int> fixed,
                const solver::Choice& choice, Execution& execution);

  /// Takes a solver that was made for the same Laplacian and fixed vertices.
  RefinedSolver(const mesh::HalfEdges& half_edges, std::span<const double> weights, std::vector<int> fixed,
                const solver::Choice& choice, std::unique_ptr<solver::LaplaceSolver> solver, Workers& workers);

  /// Makes the flux terms of the right-hand sides. Called only where something is refined.
  using Terms = std::function<FluxTerms()>;

  /// Solves L f = B, #V x #rhs, under the conditions of solver::LaplaceSolver, and refines where its accuracy is not
  /// enough.
  /// @param terms make the flux terms that B consists of
  /// @throws SolverError, Cancelled
  RowMajorMatrix solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions, const Terms& terms,
                       Execution& execution);
  RowMajorMatrix solve(const Eigen::MatrixXd& B, solver::Condition condition, const Terms& terms,
                       Execution& execution) {
    return solve(B, std::vector<solver::Condition>(B.cols(), condition), terms, execution);
  }

  /// Refines solutions where weights are so large that a small residual, 1e-10 of the right-hand side, does not mean
  /// small errors. Adds L^-1 r, r of harmonic_residuals, until |h - h_exact|^2 = r . L^-1 r is small enough, or as
  /// small as the rounding of the functions allows. Does nothing elsewhere.
  /// @throws SolverError where the error is not kEnergyError in the end; Cancelled
  void refine(RowMajorMatrix& functions, const std::vector<solver::Condition>& conditions, const Terms& terms,
              Execution& execution);

  const solver::LaplaceSolver& solver() const { return *solver_; }
  const solver::Choice& choice() const { return choice_; }
  /// Whether some weight is larger than kStiff.
  bool is_stiff() const { return is_stiff_; }
  /// The largest relative residual of the linear systems so far; where forms are refined, the largest error in energy.
  double residual() const { return is_stiff_ ? energy_error_ : solver_->residual(); }

 private:
  const mesh::HalfEdges& half_edges_;
  std::span<const double> weights_;
  std::vector<int> fixed_;
  solver::Choice choice_;
  bool is_stiff_;
  double energy_error_ = 0;
  std::unique_ptr<solver::LaplaceSolver> solver_;
};

}  // namespace holomorph::forms
