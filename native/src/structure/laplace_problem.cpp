#include "structure/laplace_problem.h"

#include "forms/laplacian.h"
#include "mesh/discretisation.h"
#include "solver/solver_choice.h"

namespace holomorph::structure {

LaplaceProblem laplace_problem(const mesh::Surface& surface, const std::vector<int>& fixed, const Options& options,
                               Execution& execution) {
  auto delaunay = mesh::on_delaunay(surface, mesh::half_edges(surface, execution), execution);
  const mesh::HalfEdges& half_edges = delaunay.half_edges;
  LaplaceProblem result;
  result.threads = execution.threads();
  result.weights = std::move(delaunay.weights);
  for (int e = 0; e < static_cast<int>(half_edges.n_edges()); ++e) {
    result.ends.push_back({mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e + 1)),
                           mesh::to_vertex(half_edges, mesh::HalfedgeHandle(2 * e))});
  }
  const auto choice = solver::choose_method(options.solver, surface.vertex_count, 1);
  result.solver =
      solver::make_solver(choice.method, forms::laplacian(half_edges, result.weights, execution), fixed, execution);
  return result;
}

}  // namespace holomorph::structure
