#include "structure/harmonic_solver.h"

#include <algorithm>
#include <vector>

#include "forms/codifferential.h"
#include "forms/laplacian.h"
#include "mesh/boundary_loops.h"

namespace holomorph::structure {
namespace {

std::unique_ptr<const DoubledSurface> doubled_where(Boundary boundary, const mesh::Discretisation& discretisation,
                                                    Execution& execution) {
  if (boundary == Boundary::natural) return nullptr;
  return std::make_unique<const DoubledSurface>(doubled(discretisation, execution));
}

// The vertices at which Dirichlet functions are 0. There are none on the double, which has no boundary.
std::vector<int> fixed_vertices(const DoubledSurface* on_double, const mesh::Discretisation& discretisation) {
  return on_double ? std::vector<int>() : mesh::boundary_vertices(discretisation.half_edges);
}

Extent extent_of(const mesh::Discretisation& discretisation, int forms) {
  return {static_cast<std::int64_t>(discretisation.half_edges.n_vertices()),
          static_cast<std::int64_t>(discretisation.weights.size()), forms};
}

std::vector<solver::Condition> conditions(int natural, int count) {
  std::vector<solver::Condition> result(count, solver::Condition::natural);
  std::fill(result.begin() + std::clamp(natural, 0, count), result.end(), solver::Condition::dirichlet);
  return result;
}

}  // namespace

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary,
                               Execution& execution)
    : discretisation_(discretisation),
      plan_(std::move(plan)),
      double_(doubled_where(boundary, discretisation, execution)),
      systems_(half_edges(), weights(), fixed_vertices(double_.get(), discretisation), plan_.choice, execution) {}

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, MemoryPlan plan, Boundary boundary,
                               const MakeSolver& make, Execution& execution)
    : discretisation_(discretisation),
      plan_(std::move(plan)),
      double_(doubled_where(boundary, discretisation, execution)),
      systems_(half_edges(), weights(), fixed_vertices(double_.get(), discretisation), plan_.choice,
               make(forms::laplacian(half_edges(), weights(), execution)), execution.workers()) {}

HarmonicSolver::HarmonicSolver(const mesh::Discretisation& discretisation, int right_hand_sides, const Options& options,
                               Execution& execution)
    : HarmonicSolver(discretisation, plan_memory(extent_of(discretisation, right_hand_sides), options, Keeping::all),
                     Boundary::natural, execution) {}

void HarmonicSolver::solve_in_blocks(const topology::IntegerForms& classes, int natural, Execution& execution,
                                     const TakeFunctions& take) {
  const int count = classes.form_count;
  const auto both =
      double_ ? extended(discretisation_.half_edges, double_->cover, classes, natural) : topology::IntegerForms();
  const topology::IntegerForms& solved = double_ ? both : classes;
  for (int first = 0; first < count; first += plan_.block) {
    const int width = std::min(plan_.block, count - first);
    execution.part(static_cast<double>(first) / count, static_cast<double>(first + width) / count);
    // On the double all conditions are natural: antisymmetric functions vanish along the boundary by themselves.
    auto functions = systems_.solve(
        forms::codifferentials(half_edges(), weights(), solved, first, width, execution.workers()),
        conditions(double_ ? width : natural - first, width), [&] { return forms::class_terms(solved, first, width); },
        execution);
    if (double_) functions = symmetrised(functions, double_->cover, std::clamp(natural - first, 0, width));
    take(first, std::move(functions));
  }
}

forms::RowMajorMatrix HarmonicSolver::solve(const topology::IntegerForms& classes, int natural, Execution& execution) {
  const auto rows = static_cast<Eigen::Index>(discretisation_.half_edges.n_vertices());
  forms::RowMajorMatrix all(rows, 0);
  solve_in_blocks(classes, natural, execution, [&](int first, forms::RowMajorMatrix&& functions) {
    // A single block is handed over without a copy.
    if (functions.cols() == classes.form_count) {
      all = std::move(functions);
      return;
    }
    if (first == 0) all.resize(rows, classes.form_count);
    all.middleCols(first, functions.cols()) = functions;
  });
  return all;
}

}  // namespace holomorph::structure
