#include "pipeline/harmonic_forms.h"

#include <algorithm>

namespace holomorph::pipeline {
SolverReport solve_in_blocks(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::LaplaceSolver& solver, const topology::IntegerForms& classes,
                             const MemoryPlan& plan, Execution& execution, const TakeFunctions& take) {
  const int count = classes.form_count;
  for (int first = 0; first < count; first += plan.block) {
    const int width = std::min(plan.block, count - first);
    execution.part(static_cast<double>(first) / count, static_cast<double>(first + width) / count);
    take(first, solver.solve(forms::codifferentials(half_edges, weights, classes, first, width, execution.workers()),
                             solver::Condition::natural, execution));
  }
  return solver_report(solver, plan.choice);
}

SolverReport solver_report(const solver::LaplaceSolver& solver, const solver::Choice& choice) {
  const std::string remark = solver.remark();
  return {
      solver.name(), choice.reason + (remark.empty() ? "" : "; " + remark), solver.iterations(), solver.residual(), {}};
}

HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::LaplaceSolver& solver, const topology::IntegerForms& classes,
                             const MemoryPlan& plan, Execution& execution) {
  HarmonicForms result{{classes, {}}, {}};
  forms::RowMajorMatrix& all = result.forms.functions;
  result.solver = solve_in_blocks(half_edges, weights, solver, classes, plan, execution,
                                  [&](int first, forms::RowMajorMatrix&& functions) {
                                    const bool whole = functions.cols() == classes.form_count;
                                    if (whole) return all.swap(functions);
                                    if (first == 0) all.resize(functions.rows(), classes.form_count);
                                    all.middleCols(first, functions.cols()) = functions;
                                  });
  return result;
}

HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Execution& execution) {
  const MemoryPlan plan = plan_memory({laplacian.size(), static_cast<std::int64_t>(weights.size()), classes.form_count},
                                      options.solver, options.memory_limit);
  const auto solver = solver::make_solver(plan.choice.method, std::move(laplacian), {}, execution);
  return harmonic_forms(half_edges, weights, *solver, classes, plan, execution);
}

}  // namespace holomorph::pipeline
