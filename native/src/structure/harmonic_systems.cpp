#include "structure/harmonic_systems.h"

#include <algorithm>

#include "forms/codifferential.h"
#include "forms/laplacian.h"
#include "solver/solver_choice.h"

namespace holomorph::structure {
namespace {

// Of the set-up, for the progress function.
constexpr double kAssembly = 0.2;

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
    FormBlock part{classes, first, std::vector<solver::Condition>(width, solver::Condition::natural)};
    std::fill(part.conditions.begin() + std::clamp(natural - first, 0, width), part.conditions.end(),
              solver::Condition::dirichlet);
    forms::RowMajorMatrix functions =
        solver_->solve(forms::codifferentials(half_edges_, weights_, classes, first, width, execution.workers()),
                       part.conditions, execution);
    if (is_stiff_) {
      const double error = refine({half_edges_, weights_, fixed_}, part, functions, *solver_, execution);
      energy_error_ = std::max(energy_error_, error);
    }
    take(first, std::move(functions));
  }
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
