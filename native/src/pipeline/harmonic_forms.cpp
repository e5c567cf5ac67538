#include "pipeline/harmonic_forms.h"

#include <algorithm>

namespace holomorph::pipeline {
namespace {

// Share of the solver's set-up in the work of several blocks, for the progress function.
constexpr double kSetUp = 0.2;

}  // namespace

SolverReport solve_in_blocks(const mesh::HalfEdges& half_edges, const std::vector<double>& weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const MemoryPlan& plan, Progress& progress, const TakeFunctions& take) {
  const int count = classes.form_count;
  const bool several = plan.block < count;
  if (several) progress.part(0, kSetUp);
  const auto solver = solver::make_solver(plan.choice.method, std::move(laplacian), {}, progress);
  for (int first = 0; first < count; first += plan.block) {
    const int width = std::min(plan.block, count - first);
    if (several) {
      progress.part(kSetUp + (1 - kSetUp) * first / count, kSetUp + (1 - kSetUp) * (first + width) / count);
    }
    take(first, solver->solve(forms::codifferentials(half_edges, weights, classes, first, width),
                              solver::Condition::natural, progress));
  }
  return solver_report(*solver, plan.choice);
}

SolverReport solver_report(const solver::LaplaceSolver& solver, const solver::Choice& choice) {
  const std::string remark = solver.remark();
  return {
      solver.name(), choice.reason + (remark.empty() ? "" : "; " + remark), solver.iterations(), solver.residual(), {}};
}

HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, const std::vector<double>& weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Progress& progress) {
  const auto vertices = static_cast<Eigen::Index>(half_edges.n_vertices());
  const MemoryPlan plan = plan_memory({vertices, static_cast<std::int64_t>(weights.size()), classes.form_count},
                                      options.solver, options.memory_limit);
  HarmonicForms result{{classes, forms::RowMajorMatrix(vertices, classes.form_count)}, {}};
  result.solver = solve_in_blocks(half_edges, weights, std::move(laplacian), classes, plan, progress,
                                  [&](int first, const Eigen::MatrixXd& functions) {
                                    result.forms.functions.middleCols(first, functions.cols()) = functions;
                                  });
  return result;
}

}  // namespace holomorph::pipeline
