#include "mesh/discretisation.h"

#include <utility>

#include "mesh/delaunay.h"
#include "mesh/metric_errors.h"

namespace holomorph::mesh {

Discretisation discretised(IntrinsicTriangulation&& triangulation, Execution& execution) {
  Discretisation result;
  result.weights = cotangent_weights(triangulation, execution);
  result.errors = energy_errors(triangulation.metric(), result.weights, execution.workers());
  result.metric_error = largest_error(triangulation.metric());
  result.mollification = triangulation.mollification;
  result.half_edges = std::move(triangulation.half_edges);
  result.lengths = std::move(triangulation.lengths);
  result.flips = std::move(triangulation.flips);
  triangulation.forget_metric();
  return result;
}

Discretisation on_input(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  return discretised(intrinsic_triangulation(surface, std::move(half_edges), execution.workers()), execution);
}

Discretisation on_input_with_errors(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  auto triangulation = given_triangulation(surface, std::move(half_edges), execution.workers());
  if (triangulation.degenerate) mollify(triangulation, execution.workers());
  return discretised(std::move(triangulation), execution);
}

Discretisation on_delaunay(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  auto triangulation = given_triangulation(surface, std::move(half_edges), execution.workers());
  make_delaunay(triangulation, execution);
  return discretised(std::move(triangulation), execution);
}

}  // namespace holomorph::mesh
