// Surfaces of triangles and edge lengths, without positions.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "mesh/metric_errors.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// The triangulation that is solved on: a metric given by edge lengths, made Delaunay by flips that move no vertex.

/// An edge flip. A closed form has on the new edge the value  -(value along `a` + value along `b`),
/// where a and b are half-edges of two sides of the quadrilateral, as they were numbered at that moment.
struct Flip {
  int edge;
  HalfedgeHandle a, b;
};

struct IntrinsicTriangulation {
  HalfEdges half_edges;
  Array<double> lengths;     ///< #E
  Array<double> cotangents;  ///< #half-edges: cotangent of the angle opposite; 0 outside the surface
  std::vector<Flip> flips;   ///< in order, from the input triangulation to this one
  double mollification = 0;  ///< added to some lengths, in their unit; with 0 the metric is that of the surface
  bool degenerate = false;   ///< whether a triangle is degenerate; then none has been mollified yet

  /// #F, how much rounding may change energies on each face; empty if a triangle is mollified.
  Array<FaceError> metric_errors;

  Metric metric() const { return {half_edges, lengths, cotangents, metric_errors}; }

  /// Frees what only the weights need.
  void forget_metric() {
    lengths = Array<double>();
    cotangents = Array<double>();
    metric_errors = Array<FaceError>();
  }
};

/// Returns the input triangulation in its own metric, degenerate triangles included. make_delaunay removes most of them
/// without mollifying. @param half_edges of the surface
IntrinsicTriangulation given_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers);

/// Lengthens all sides of degenerate triangles, and of triangles that become degenerate by it, by one common amount.
/// This leaves each triangle a slack of 1e-6 times their mean length. (Sharp & Crane 2020, doi:10.1111/cgf.14069,
/// section 4.5, lengthen every edge of the mesh.)
/// @return whether there was one
bool mollify(IntrinsicTriangulation& triangulation, Workers& workers);

/// Mollifies only the triangles that have a side of length 0.
void mollify_needles(IntrinsicTriangulation& triangulation, Workers& workers);

/// Returns the given_triangulation, mollified, without metric errors: for results that have no bounds.
IntrinsicTriangulation intrinsic_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers);

/// Returns the length that intrinsic_triangulation adds to edges; 0 if no triangle is degenerate.
double mollification(const Surface& surface, Execution& execution);

/// Recomputes the cotangents opposite the half-edges of the face of `h` from the present lengths.
void set_cotangents(IntrinsicTriangulation& triangulation, HalfedgeHandle h);

/// Returns the weights k = (cot a + cot b) / 2 (paper Eq. 3), #E, those of thin triangles to all digits.
Array<double> cotangent_weights(const IntrinsicTriangulation& triangulation, Execution& execution);

/// Makes an intrinsic surface: triangles and the lengths of their edges, without positions.
/// @param faces #F vertices; a vertex may come twice in a triangle
/// @param lengths #F lengths, entry i opposite corner i; both triangles at an edge must agree to 1e-9
/// @param face_edges #F edge names, entry i opposite corner i; empty: edges are told apart by their ends
Surface make_intrinsic_surface(int vertex_count, const std::vector<std::array<std::int64_t, 3>>& faces,
                               const std::vector<std::array<double, 3>>& lengths,
                               const std::vector<std::array<std::int64_t, 3>>& face_edges, Execution& execution);

}  // namespace holomorph::mesh
