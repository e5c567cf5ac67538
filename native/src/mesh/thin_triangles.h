// Triangles so thin that the rounding of lengths shows: their weights in twice the working precision, and by how much
// that rounding may change energies.
#pragma once

#include <array>
#include <span>

#include "base/workers.h"
#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// Relative error of the energies of forms on a triangle with these sides: 8 of the rounding of lengths times the
/// circumradius over the inradius, for |E' - E| <= |g' - g| E, g the metric of constant coefficients. At most 1: then
/// the area is one that rounding leaves open.
struct MetricError {
  double relative, area;
};
MetricError metric_error(const std::array<double, 3>& sides);

/// A triangulation by its lengths, #E, with its cotangents, #half-edges, and the relative errors of its faces, none
/// where all are 0.
struct Metric {
  const HalfEdges& half_edges;
  std::span<const double> lengths, cotangents, errors;
};

/// One for each face, 0 where it is not thin.
Array<double> metric_errors(const Metric& metric, Workers& workers);

/// Whether a face at the edge of `h` has an error.
bool has_error(const Metric& metric, HalfedgeHandle h);

/// The errors of the face of `h` and of its neighbour across h, with the areas that they stand for.
std::array<MetricError, 2> errors_beside(const Metric& metric, HalfedgeHandle h);

/// After the flip of the edge of `h`, the errors of the same two faces: the mean of those before, by area, and that of
/// the new length.
std::array<double, 2> mixed_errors(const Metric& metric, HalfedgeHandle h, const std::array<MetricError, 2>& before);

/// The weights of the edges of triangles with an error, anew: opposite obtuse angles, what cot + cot leaves has as many
/// digits less as the cotangents are larger.
void sharpen_weights(const Metric& metric, Array<double>& weights, Workers& workers);

/// #E numbers u: sum_e u_e h(e)^2 bounds by how much rounding changes the energy of a form h; none where there are no
/// errors. @param weights cotangent_weights
Array<double> energy_errors(const Metric& metric, const Array<double>& weights, Workers& workers);

}  // namespace holomorph::mesh
