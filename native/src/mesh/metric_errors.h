// Proven bounds, for every triangle, on how much the rounding of lengths changes the energies of forms. Weights of very
// thin triangles, in twice the working precision.
//
// A triangulation with rounded lengths is a surface of its own. The map to the surface that it stands for, affine on
// each triangle, changes metrics by a relative error there; flips compose such maps. A function on the rounded surface,
// carried over by the map, is admissible, and its energy is larger by no more than these errors say. So it bounds the
// invariants of the surface as given (docs/guarantee.md).
#pragma once

#include <array>
#include <span>

#include "base/workers.h"
#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// Relative error of a form's energy on a face: how much larger it may be on the surface that the face stands for. The
/// mean over the face, and the maximum in it. 1 stands for what rounding leaves open altogether.
struct FaceError {
  double mean = 0, largest = 0;
};

/// A length that stands for another one, which it misses by no more than `error`.
struct RoundedLength {
  double length, error;
};

/// A triangulation by its lengths, #E, with its cotangents, #half-edges, and the errors of its faces, none where the
/// metric is another one (mollified).
struct Metric {
  const HalfEdges& half_edges;
  std::span<const double> lengths, cotangents;
  std::span<const FaceError> errors;
};

/// Relative error of the lengths of a surface: of those from positions, which are exact, or of given ones.
double length_error(const Surface& surface);

/// Bounds the errors that the rounding of a surface's lengths causes: the given ones (Surface::metric_errors), or
/// those of lengths from positions.
Array<FaceError> metric_errors(const Metric& metric, const Surface& surface, Workers& workers);

/// Returns the relative amount by which energies of forms on a triangle with these sides may grow; 1 if rounding leaves
/// its area open. @param open set to the area, or to a bound of it where it is open
double energy_growth(const std::array<RoundedLength, 3>& sides, double* open = nullptr);

/// The errors of the face of `h` and of its neighbour across h, with their areas.
struct FacesBeside {
  std::array<FaceError, 2> errors;
  std::array<double, 2> areas;
};
FacesBeside faces_beside(const Metric& metric, HalfedgeHandle h);

/// After the flip of the edge of `h`, the errors of the same two faces. @param error of the new length
std::array<FaceError, 2> errors_after_flip(const Metric& metric, HalfedgeHandle h, const FacesBeside& before,
                                           double error);

/// Recomputes the weights of the edges of thin triangles: opposite obtuse angles, large cotangents cancel in cot + cot,
/// and digits are lost.
void sharpen_weights(const Metric& metric, Array<double>& weights, Workers& workers);

/// Returns numbers u, #E, or none where there are no errors. The energy of a form h on the surface as given is at most
/// sum_e (k_e + u_e) h(e)^2, the rounding of the weights included. @param weights cotangent_weights
Array<double> energy_errors(const Metric& metric, const Array<double>& weights, Workers& workers);

/// What the energies of forms on a face are made of, from one of its half-edges on: sum_i cot_i q_i, q_i the
/// integral of the squared derivative along side i over a triangle of area 1 / 2, cot_i the cotangent opposite. On the
/// surface as given, the energy of any form is at most sum_i (cot_i + u_i) q_i, the rounding of cot_i included.
struct FaceWeights {
  std::array<double, 3> cotangents, errors;
};
FaceWeights face_weights(const Metric& metric, HalfedgeHandle h);

/// The largest error of any face: with 1, energies are not bounded.
double largest_error(const Metric& metric);

}  // namespace holomorph::mesh
