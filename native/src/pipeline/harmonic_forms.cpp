#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

SolverReport solver_report(const solver::LaplaceSolver& solver, const solver::Choice& choice) {
  const std::string remark = solver.remark();
  return {
      solver.name(), choice.reason + (remark.empty() ? "" : "; " + remark), solver.iterations(), solver.residual(), {}};
}

HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, const std::vector<double>& weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Progress& progress) {
  const auto choice = solver::choose_method(options.solver, laplacian.rows(), classes.form_count);
  const auto solver = solver::make_solver(choice.method, std::move(laplacian), {}, progress);
  HarmonicForms result;
  result.forms = forms::harmonic_basis(half_edges, weights, classes, *solver, solver::Condition::natural, progress);
  result.solver = solver_report(*solver, choice);
  return result;
}

}  // namespace holomorph::pipeline
