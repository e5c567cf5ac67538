// The intrinsic Delaunay triangulation, and what linear systems need of it.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/intrinsic_surface.h"

namespace holomorph::mesh {

/// Flips edges until every interior edge is Delaunay, cot + cot >= 0 up to rounding (Fisher et al. 2007,
/// doi:10.1007/s00607-007-0249-8). In exact arithmetic it ends because every flip lowers the Dirichlet energy of every
/// function (Rippa 1990), so no triangulation recurs. In rounded arithmetic it ends because the flips of each edge are
/// limited.
/// Cost: linear in the number of flips, which is about a fifth of the edges of irregular meshes. Flips are made in
/// parallel where faces with near numbers are near each other, with the same result at any number of threads. A
/// degenerate triangle goes with the flip of its longest side, and the metric is still that of the surface. Only those
/// with a side without length, or with their longest side on the boundary, are mollified.
void make_delaunay(IntrinsicTriangulation& triangulation, Execution& execution);

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
