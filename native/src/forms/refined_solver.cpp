#include "forms/refined_solver.h"

#include <cmath>
#include <sstream>

#include "base/constants.h"
#include "base/errors.h"
#include "base/workers.h"
#include "forms/laplacian.h"

namespace holomorph::forms {
namespace {

// Steps of iterative refinement, at most.
constexpr int kMostSteps = 10;
// Refinement ends at a step that leaves more than this part of the error.
constexpr double kLeastGain = 0.5;
// Part of the set-up that assembly takes, for the progress function.
constexpr double kAssembly = 0.2;

bool has_large(std::span<const double> weights, Workers& workers) {
  const int count = static_cast<int>(weights.size());
  // Written so that a weight that is not a number counts as large.
  return first_row(workers, count, [&](int e) { return !(std::abs(weights[e]) <= kStiff); }) < count;
}

// The largest sqrt(r . L^-1 r) over that of the energy.
double energy_error(const HarmonicResiduals& residuals, const solver::Solution& corrections) {
  double worst = 0;
  for (Eigen::Index j = 0; j < corrections.cols(); ++j) {
    const double square = std::abs(residuals.R.col(j).dot(corrections.col(j)));
    if (square == 0) continue;  // an energy of 0, that of no form at all, divides nothing
    const double error = std::sqrt(square / std::abs(residuals.energies[j]));
    if (!(error <= worst)) worst = error;  // std::max would drop a NaN
  }
  return worst;
}

}  // namespace

RefinedSolver::RefinedSolver(const mesh::HalfEdges& half_edges, std::span<const double> weights, std::vector<int> fixed,
                             const solver::Choice& choice, Execution& execution)
    : half_edges_(half_edges),
      weights_(weights),
      fixed_(std::move(fixed)),
      choice_(choice),
      is_stiff_(has_large(weights, execution.workers())) {
  execution.part(0, kAssembly);
  auto L = laplacian(half_edges, weights, execution);
  execution.part(kAssembly, 1);
  solver_ = solver::make_solver(choice.method, std::move(L), fixed_, execution);
}

RefinedSolver::RefinedSolver(const mesh::HalfEdges& half_edges, std::span<const double> weights, std::vector<int> fixed,
                             const solver::Choice& choice, std::unique_ptr<solver::LaplaceSolver> solver,
                             Workers& workers)
    : half_edges_(half_edges),
      weights_(weights),
      fixed_(std::move(fixed)),
      choice_(choice),
      is_stiff_(has_large(weights, workers)),
      solver_(std::move(solver)) {}

RowMajorMatrix RefinedSolver::solve(const Eigen::MatrixXd& B, const std::vector<solver::Condition>& conditions,
                                    const Terms& terms, Execution& execution) {
  RowMajorMatrix functions = solver_->solve(B, conditions, execution);
  refine(functions, conditions, terms, execution);
  return functions;
}

void RefinedSolver::refine(RowMajorMatrix& functions, const std::vector<solver::Condition>& conditions,
                           const Terms& terms, Execution& execution) {
  if (!is_stiff_) return;
  const FluxTerms fluxes = terms();
  double error = kInfinity;
  for (int step = 0; step < kMostSteps && error > kEnergyGoal; ++step) {
    auto residuals = harmonic_residuals(half_edges_, weights_, fluxes, functions, execution.workers());
    for (Eigen::Index j = 0; j < functions.cols(); ++j) {
      // At fixed vertices r is the flux through the boundary, which is no error.
      if (conditions[j] == solver::Condition::dirichlet) residuals.R(fixed_, j).setZero();
    }
    // L^-1 r is the error of the functions, up to the solver's accuracy, and r . L^-1 r its energy.
    const solver::Solution corrections = solver_->solve(residuals.R, conditions, execution);
    const double now = energy_error(residuals, corrections);
    const bool gains = now <= kLeastGain * error;
    // A last correction that made it worse, or not a number, counts as it is.
    if (gains || !(now <= error)) error = now;
    // The rounding of the functions is reached: another correction would gain nothing.
    if (!gains) break;
    functions += corrections;
  }
  energy_error_ = std::max(energy_error_, error);
  if (error <= kEnergyError) return;
  std::ostringstream message;
  message << "the forms have a relative error of " << error << " in energy instead of " << kEnergyError
          << ", on a system of " << functions.rows() << " unknowns: triangles are too thin for double precision";
  throw SolverError(message.str());
}

}  // namespace holomorph::forms
