#include "structure/harmonic_systems.h"

#include <algorithm>

#include "forms/codifferential.h"

namespace holomorph::structure {

HarmonicSystems::HarmonicSystems(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                 const std::vector<int>& fixed, const solver::Choice& choice, Execution& execution)
    : half_edges_(half_edges), weights_(weights), solver_(half_edges, weights, fixed, choice, execution) {}

void HarmonicSystems::solve_in_blocks(const topology::IntegerForms& classes, int natural, int block,
                                      Execution& execution, const TakeFunctions& take) {
  const int count = classes.form_count;
  for (int first = 0; first < count; first += block) {
    const int width = std::min(block, count - first);
    execution.part(static_cast<double>(first) / count, static_cast<double>(first + width) / count);
    std::vector<solver::Condition> conditions(width, solver::Condition::natural);
    std::fill(conditions.begin() + std::clamp(natural - first, 0, width), conditions.end(),
              solver::Condition::dirichlet);
    forms::RowMajorMatrix functions = solver_.solve(
        forms::codifferentials(half_edges_, weights_, classes, first, width, execution.workers()), conditions,
        [&] { return forms::class_terms(classes, first, width); }, execution);
    take(first, std::move(functions));
  }
}

SolverReport HarmonicSystems::report() const { return solver_report(solver_); }

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
