#include "structure/harmonic_systems.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "base/chunks.h"
#include "base/errors.h"
#include "forms/codifferential.h"
#include "forms/harmonic_residuals.h"
#include "forms/laplacian.h"
#include "solver/solver_choice.h"

namespace holomorph::structure {
namespace {

// Of the set-up, for the progress function.
constexpr double kAssembly = 0.2;
// Up to this weight a relative residual of 1e-10 keeps the error in energy far below kEnergyGoal.
constexpr double kStiff = 1e3;
constexpr int kMostRefinements = 10;
// A step of refinement that leaves more than this part of the error was the last.
constexpr double kLeastGain = 0.5;

// Whether some weight is beyond kStiff.
bool is_stiff(std::span<const double> weights, Workers& workers) {
  const int count = static_cast<int>(weights.size());
  return first_row(workers, count, [&](int e) { return !(std::abs(weights[e]) <= kStiff); }) < count;
}

// The largest sqrt(r . L^-1 r) over that of the energy.
double energy_error(const forms::HarmonicResiduals& residuals, const solver::Solution& corrections) {
  double worst = 0;
  for (Eigen::Index j = 0; j < corrections.cols(); ++j) {
    const double square = std::abs(residuals.R.col(j).dot(corrections.col(j)) / residuals.energies[j]);
    if (!(std::sqrt(square) <= worst)) worst = std::sqrt(square);  // std::max would drop a NaN
  }
  return worst;
}

}  // namespace

HarmonicSystems::HarmonicSystems(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                 const std::vector<int>& fixed, const solver::Choice& choice, Execution& execution)
    : half_edges_(half_edges),
      weights_(weights),
      fixed_(fixed),
      choice_(choice),
      is_stiff_(is_stiff(weights, execution.workers())) {
  execution.part(0, kAssembly);
  auto laplacian = forms::laplacian(half_edges, weights, execution);
  execution.part(kAssembly, 1);
  solver_ = solver::make_solver(choice.method, std::move(laplacian), fixed, execution);
}

void HarmonicSystems::solve_in_blocks(const topology::IntegerForms& classes, int natural, int block,
                                      Execution& execution, const TakeFunctions& take) {
  const int count = classes.form_count;
  for (int first = 0; first < count; first += block) {
    const int width = std::min(block, count - first);
    execution.part(static_cast<double>(first) / count, static_cast<double>(first + width) / count);
    Block part{first, std::vector<solver::Condition>(width, solver::Condition::natural)};
    std::fill(part.conditions.begin() + std::clamp(natural - first, 0, width), part.conditions.end(),
              solver::Condition::dirichlet);
    take(first, solve_block(classes, part, execution));
  }
}

forms::RowMajorMatrix HarmonicSystems::solve_block(const topology::IntegerForms& classes, const Block& block,
                                                   Execution& execution) {
  const int width = static_cast<int>(block.conditions.size());
  forms::RowMajorMatrix functions =
      solver_->solve(forms::codifferentials(half_edges_, weights_, classes, block.first, width, execution.workers()),
                     block.conditions, execution);
  if (is_stiff_) refine(classes, block, functions, execution);
  return functions;
}

void HarmonicSystems::refine(const topology::IntegerForms& classes, const Block& block,
                             forms::RowMajorMatrix& functions, Execution& execution) {
  double error = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostRefinements; ++step) {
    auto residuals =
        forms::harmonic_residuals(half_edges_, weights_, classes, block.first, functions, execution.workers());
    for (Eigen::Index j = 0; j < functions.cols(); ++j) {
      if (block.conditions[j] == solver::Condition::dirichlet) residuals.R(fixed_, j).setZero();
    }
    const solver::Solution corrections = solver_->solve(residuals.R, block.conditions, execution);
    const double before = std::exchange(error, energy_error(residuals, corrections));
    if (!(error <= kLeastGain * before)) {
      error = std::min(error, before);
      break;
    }
    functions += corrections;
    if (error <= kEnergyGoal) break;
  }
  if (!(error <= kEnergyError)) {
    std::ostringstream message;
    message << "the harmonic forms of a system of " << functions.rows() << " unknowns have a relative error of "
            << error << " in energy instead of " << kEnergyError << ": triangles are too thin for double precision";
    throw SolverError(message.str());
  }
  energy_error_ = std::max(energy_error_, error);
}

SolverReport HarmonicSystems::report() const {
  SolverReport result = solver_report(*solver_, choice_);
  if (is_stiff_) result.residual = energy_error_;
  return result;
}

HarmonicFunctions HarmonicSystems::solve(const topology::IntegerForms& classes, int natural, int block,
                                         Execution& execution) {
  HarmonicFunctions result;
  auto& all = result.functions;
  if (classes.form_count == 0) all.resize(static_cast<Eigen::Index>(half_edges_.n_vertices()), 0);
  solve_in_blocks(classes, natural, block, execution, [&](int first, forms::RowMajorMatrix&& functions) {
    if (functions.cols() == classes.form_count) return all.swap(functions);
    if (first == 0) all.resize(functions.rows(), classes.form_count);
    all.middleCols(first, functions.cols()) = functions;
  });
  result.solver = report();
  return result;
}

}  // namespace holomorph::structure
