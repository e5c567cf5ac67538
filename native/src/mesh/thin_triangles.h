// Triangles so thin that the rounding of lengths shows: their weights in twice the working precision, and by how much
// that rounding may change energies.
#pragma once

#include <array>

#include "mesh/intrinsic_triangulation.h"

namespace holomorph::mesh {

/// Relative error of the energies of forms on a triangle with these sides: 8 of the rounding of lengths times the
/// circumradius over the inradius, for |E' - E| <= |g' - g| E, g the metric of constant coefficients. At most 1: then
/// the area is one that rounding leaves open.
struct MetricError {
  double relative, area;
};
MetricError metric_error(const std::array<double, 3>& sides);

/// Sets metric_errors: one for each face, 0 where it is not thin.
void set_metric_errors(IntrinsicTriangulation& triangulation, Workers& workers);

/// Whether a face at the edge of `h` has a metric error.
bool has_metric_error(const IntrinsicTriangulation& triangulation, HalfedgeHandle h);

/// That of the face of `h` as it is, with the area that it stands for.
MetricError face_error(const IntrinsicTriangulation& triangulation, HalfedgeHandle h);

/// After the flip of the edge of `h`: each of its two faces has the mean of the errors of the two before, by area, and
/// that of the new length.
void mix_metric_errors(IntrinsicTriangulation& triangulation, HalfedgeHandle h,
                       const std::array<MetricError, 2>& before);

/// The weights of the edges of triangles with a metric error, anew: opposite obtuse angles, what cot + cot leaves has
/// as many digits less as the cotangents are larger.
void sharpen_weights(const IntrinsicTriangulation& triangulation, Array<double>& weights, Workers& workers);

/// #E numbers u: sum_e u_e h(e)^2 bounds by how much rounding changes the energy of a form h; none where no triangle of
/// the surface is thin, and none where some were mollified: there are no bounds then. @param weights cotangent_weights
Array<double> energy_errors(const IntrinsicTriangulation& triangulation, const Array<double>& weights,
                            Workers& workers);

}  // namespace holomorph::mesh
