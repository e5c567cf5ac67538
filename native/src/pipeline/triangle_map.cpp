#include "pipeline/triangle_map.h"

#include <algorithm>
#include <complex>

#include "base/errors.h"
#include "mesh/boundary_loops.h"
#include "mesh/edge_ends.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::pipeline {

TriangleMap triangle_map(const mesh::Surface& surface, const Options& options, Execution& execution) {
  TriangleMap result;
  execution.stage("boundary", 0.0, 0.3);
  auto half_edges = mesh::half_edges(surface, execution);
  const auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto& loop = boundary.loops[0];  // the hole on its left: the surface has it the other way round
  if (loop.size() != 3)
    throw TopologyError("the boundary has " + std::to_string(loop.size()) + " edges; three are needed");
  const auto triangulation = mesh::intrinsic_triangulation(surface, std::move(half_edges), execution.workers());
  result.mollification = triangulation.mollification;
  const auto vertex = [&](int i) { return mesh::from_vertex(surface, loop[i]); };
  const auto length = [&](int i) { return triangulation.lengths[mesh::edge_of(loop[i])]; };
  // vertices 0, 2, 1 are counter-clockwise; a runs from 0 to 2, b from 2 to 1, c from 1 to 0
  const double a = length(2), b = length(1), c = length(0), scale = 1 / std::max({a, b, c});
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(surface.vertex_count, 2);
  z(vertex(2), 0) = a * scale;
  z(vertex(1), 0) = ((c - b) * (c + b) + a * a) / (2 * a) * scale;
  // a boundary that is no triangle, which a curved disk may have, is made an isosceles one
  const double area = mesh::triangle_area(a, b, c);
  z(vertex(1), 1) = mesh::is_degenerate(a, b, c) ? a * scale / 2 : 2 * area / a * scale;

  execution.stage("harmonic map", 0.3, 1.0);
  const auto weights = mesh::cotangent_weights(triangulation, execution);
  auto laplacian = forms::laplacian(triangulation.half_edges, weights, execution);
  const std::vector<int> held{vertex(0), vertex(1), vertex(2)};
  if (surface.vertex_count > 3) {
    const auto L = laplacian.matrix();
    const Eigen::MatrixXd B = -(L * z);
    const double largest = (L.cwiseAbs() * z.cwiseAbs()).maxCoeff();
    auto matrix = laplacian;
    const auto choice = solver::choose_method(options.solver, L.rows(), 2);
    const auto solver = solver::make_solver(choice.method, std::move(matrix), held, execution);
    z += solver->solve(B, solver::Condition::dirichlet, execution);
    Eigen::MatrixXd rest = L * z;
    for (const int v : held) rest.row(v).setZero();
    result.harmonicity = rest.cwiseAbs().maxCoeff() / largest;
    result.solver = solver_report(*solver, choice);
  } else {
    result.solver.name = "none";
    result.solver.reason = "a single triangle";
  }
  result.points = z.col(0).cast<std::complex<double>>() + std::complex<double>(0, 1) * z.col(1);
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::pipeline
