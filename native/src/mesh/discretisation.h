// What harmonic forms are solved for on: a triangulation of a surface, the weights of its edges, the errors of its
// metric.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/intrinsic_triangulation.h"

namespace holomorph::mesh {

struct Discretisation {
  HalfEdges half_edges;
  Array<double> lengths;     ///< #E
  Array<double> weights;     ///< #E, (cot a + cot b) / 2 (paper Eq. 3)
  Array<double> errors;      ///< #E, energy_errors; none where no bounds are wanted or the metric is another one
  double metric_error = 0;   ///< largest relative error of a triangle's energy from rounding; 1 if unknown
  double mollification = 0;  ///< added to some lengths, in their unit; with 0 the metric is that of the surface
  std::vector<Flip> flips;   ///< in order, from the surface's own triangles to these
};

/// Computes the weights and errors of a triangulation.
Discretisation discretised(IntrinsicTriangulation&& triangulation, Execution& execution);

/// The surface's own triangles; degenerate ones are mollified. Without errors. @param half_edges of the surface
Discretisation on_input(const Surface& surface, HalfEdges half_edges, Execution& execution);

/// The same with errors.
Discretisation on_input_with_errors(const Surface& surface, HalfEdges half_edges, Execution& execution);

/// The intrinsic Delaunay triangulation, on which energies are least. @param half_edges of the surface
Discretisation on_delaunay(const Surface& surface, HalfEdges half_edges, Execution& execution);

}  // namespace holomorph::mesh
