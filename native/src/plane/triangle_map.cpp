#include "plane/triangle_map.h"

#include <algorithm>

#include "base/errors.h"
#include "base/finite.h"
#include "mesh/boundary_loops.h"
#include "mesh/discretisation.h"
#include "mesh/edge_ends.h"
#include "mesh/triangle_geometry.h"
#include "plane/dirichlet_problem.h"

namespace holomorph::plane {

PlaneMap triangle_map(const mesh::Surface& surface, const Options& options, Execution& execution) {
  PlaneMap result;
  execution.stage("boundary", 0.0, 0.3);
  auto half_edges = mesh::half_edges(surface, execution);
  const auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto& loop = boundary.loops[0];  // the hole on its left: clockwise around the surface
  if (loop.size() != 3)
    throw TopologyError("the boundary has " + std::to_string(loop.size()) + " edges; three are needed");
  const auto input = mesh::on_input(surface, std::move(half_edges), execution);
  result.mollification = input.mollification;
  const auto vertex = [&](int i) { return mesh::from_vertex(surface, loop[i]); };
  const auto length = [&](int i) { return input.lengths[mesh::edge_of(loop[i])]; };
  // vertices 0, 2, 1 are counter-clockwise; a runs from 0 to 2, b from 2 to 1, c from 1 to 0
  const double a = length(2), b = length(1), c = length(0), scale = 1 / std::max({a, b, c});
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(surface.vertex_count, 2);
  z(vertex(2), 0) = a * scale;
  z(vertex(1), 0) = ((c - b) * (c + b) + a * a) / (2 * a) * scale;
  // a boundary that is not a triangle, which a curved disk may have, is made an isosceles one
  const double area = mesh::triangle_area(a, b, c);
  z(vertex(1), 1) = mesh::is_degenerate(a, b, c) ? a * scale / 2 : 2 * area / a * scale;

  execution.stage("harmonic map", 0.3, 1.0);
  if (surface.vertex_count > 3) {
    auto solved = solve_dirichlet(input, {vertex(0), vertex(1), vertex(2)}, z, options, execution);
    z = solved.functions;
    result.harmonicity = solved.harmonicity;
    result.solver = std::move(solved.solver);
  } else {
    result.solver.name = "none";
    result.solver.reason = "a single triangle";
  }
  result.points.resize(surface.vertex_count);
  result.points.real() = z.col(0);
  result.points.imag() = z.col(1);
  require_finite(result.points, "vertex", execution.workers());
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::plane
