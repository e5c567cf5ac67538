// The triangulation that is solved on: a metric given by edge lengths, made Delaunay by flips that move no vertex.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"

namespace holomorph::mesh {

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
  double mollification = 0;  ///< added to every length, in their unit

  /// Frees lengths and cotangents, which only the weights need.
  void forget_metric() {
    lengths = Array<double>();
    cotangents = Array<double>();
  }
};

/// 0 if no triangle is degenerate; else the increment of all lengths that intrinsic_triangulation takes.
double smallest_increment(const Surface& surface, Workers& workers);

/// The input triangulation in its own metric. Where a triangle is degenerate, all lengths grow by the smallest
/// common amount that leaves every triangle a slack of 1e-6 times the mean length (Sharp & Crane 2020,
/// doi:10.1111/cgf.14069, section 4.5).
/// @param half_edges of the surface
IntrinsicTriangulation intrinsic_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers);

/// The cotangents opposite the half-edges of the face of `h`, from the lengths as they are.
void set_cotangents(IntrinsicTriangulation& triangulation, HalfedgeHandle h);

/// #E weights k = (cot a + cot b) / 2 (paper Eq. 3).
Array<double> cotangent_weights(const IntrinsicTriangulation& triangulation, Execution& execution);

}  // namespace holomorph::mesh
