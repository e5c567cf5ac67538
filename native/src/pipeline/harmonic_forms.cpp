#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, const std::vector<double>& weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Progress& progress) {
  const auto choice = solver::choose_method(options.solver, laplacian.rows(), classes.form_count);
  const auto solver = solver::make_solver(choice.method, std::move(laplacian), {}, progress);
  HarmonicForms result;
  result.forms = forms::harmonic_basis(half_edges, weights, classes, *solver, progress);
  const std::string remark = solver->remark();
  result.solver = {solver->name(), choice.reason + (remark.empty() ? "" : "; " + remark), solver->iterations(),
                   solver->residual()};
  return result;
}

}  // namespace holomorph::pipeline
