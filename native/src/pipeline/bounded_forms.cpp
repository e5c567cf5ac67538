#include "pipeline/bounded_forms.h"

#include "pipeline/double_cover_forms.h"
#include "topology/homology.h"

namespace holomorph::pipeline {
namespace {

using solver::Condition;

// The right-hand sides of both families, solved together.
Eigen::MatrixXd solve_both(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                           const topology::IntegerForms& natural, const topology::IntegerForms& relative,
                           solver::LaplaceSolver& solver, Execution& execution) {
  const int n = natural.form_count;
  Eigen::MatrixXd B(half_edges.n_vertices(), 2 * n);
  B.leftCols(n) = forms::codifferentials(half_edges, weights, natural, execution.workers());
  B.rightCols(n) = forms::codifferentials(half_edges, weights, relative, execution.workers());
  std::vector<Condition> conditions(n, Condition::natural);
  conditions.resize(2 * static_cast<std::size_t>(n), Condition::dirichlet);
  return solver.solve(B, conditions, execution);
}

}  // namespace

void add_indicators(const mesh::BoundaryLoops& boundary, int handles, forms::RowMajorMatrix& functions) {
  for (int v = 0; v < static_cast<int>(boundary.loop_of_vertex.size()); ++v) {
    if (const int k = boundary.loop_of_vertex[v]; k > 0) functions(v, handles + k - 1) += 1;
  }
}

forms::RowMajorMatrix side_by_side(const BoundedForms& forms) {
  forms::RowMajorMatrix both(forms.natural.functions.rows(),
                             forms.natural.functions.cols() + forms.dirichlet.functions.cols());
  both << forms.natural.functions, forms.dirichlet.functions;
  return both;
}

BoundedForms bounded_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                           solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                           const mesh::BoundaryLoops& boundary, const Options& options, Execution& execution) {
  if (options.boundary == "double_cover")
    return double_cover_forms(half_edges, weights, classes, boundary, options, execution);
  const int n = classes.form_count, handles = n - (boundary.count() - 1);
  const auto choice = choice_with_all_forms({laplacian.size(), static_cast<std::int64_t>(weights.size()), 2 * n},
                                            options.solver, options.memory_limit);
  const auto solver =
      solver::make_solver(choice.method, std::move(laplacian), mesh::boundary_vertices(boundary), execution);
  auto relative = topology::first_forms(classes, handles, handles);
  topology::add_loop_indicators(half_edges, boundary, relative);
  const Eigen::MatrixXd functions = solve_both(half_edges, weights, classes, relative, *solver, execution);
  BoundedForms result;
  result.natural = {classes, functions.leftCols(n)};
  result.dirichlet = {topology::first_forms(classes, handles, n), functions.rightCols(n)};
  add_indicators(boundary, handles, result.dirichlet.functions);

  result.solver = solver_report(*solver, choice);
  return result;
}

}  // namespace holomorph::pipeline
