#include "structure/refinement.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "base/chunks.h"
#include "base/errors.h"
#include "forms/harmonic_residuals.h"

namespace holomorph::structure {
namespace {

// Up to this weight the rounding of fluxes, even among some as much smaller, keeps errors below kEnergyError.
constexpr double kStiff = 1e4;
constexpr int kMostSteps = 10;
// A step that leaves more than this part of the error was the last.
constexpr double kLeastGain = 0.5;

// The largest sqrt(r . L^-1 r) over that of the energy.
double energy_error(const forms::HarmonicResiduals& residuals, const solver::Solution& corrections) {
  double worst = 0;
  for (Eigen::Index j = 0; j < corrections.cols(); ++j) {
    const double error = std::sqrt(std::abs(residuals.R.col(j).dot(corrections.col(j)) / residuals.energies[j]));
    if (!(error <= worst)) worst = error;  // std::max would drop a NaN
  }
  return worst;
}

}  // namespace

bool is_stiff(std::span<const double> weights, Workers& workers) {
  const int count = static_cast<int>(weights.size());
  return first_row(workers, count, [&](int e) { return !(std::abs(weights[e]) <= kStiff); }) < count;
}

double refine(const WeightedEdges& edges, const FormBlock& block, forms::RowMajorMatrix& functions,
              solver::LaplaceSolver& solver, Execution& execution) {
  double error = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps && error > kEnergyGoal; ++step) {
    auto residuals = forms::harmonic_residuals(edges.half_edges, edges.weights, block.classes, block.first, functions,
                                               execution.workers());
    for (Eigen::Index j = 0; j < functions.cols(); ++j) {
      if (block.conditions[j] == solver::Condition::dirichlet) residuals.R(edges.fixed, j).setZero();
    }
    const solver::Solution corrections = solver.solve(residuals.R, block.conditions, execution);
    const double now = energy_error(residuals, corrections);
    if (!(now <= kLeastGain * error)) break;
    error = now;
    functions += corrections;
  }
  if (error <= kEnergyError) return error;
  std::ostringstream message;
  message << "the harmonic forms have a relative error of " << error << " in energy instead of " << kEnergyError
          << ", on a system of " << functions.rows() << " unknowns: triangles are too thin for double precision";
  throw SolverError(message.str());
}

}  // namespace holomorph::structure
