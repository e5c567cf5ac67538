// Straight walks over a surface, and distances along its edges.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <utility>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// A point in a triangle in the plane: corner 0 at 0, corner 1 on the positive real axis, counter-clockwise.
struct SurfacePoint {
  int triangle = 0;
  std::complex<double> z;
};

/// The corners of a triangle in that plane.
std::array<std::complex<double>, 3> corners(const Surface& surface, int triangle);

/// Barycentric coordinates of the point in its triangle, not below 0.
Eigen::Vector3d barycentric(const Surface& surface, const SurfacePoint& point);

/// Steps dz, each in the frame of its triangle.
using WalkSteps = std::vector<std::pair<int, std::complex<double>>>;

/// Returns the corner of a vertex, moved inwards a little, so that a walk can begin there.
SurfacePoint at_vertex(const Surface& surface, int triangle, int vertex);

/// Moves the point along a geodesic that leaves with `dz`, across edges by unfolding; it ends early at the boundary and
/// after `most_triangles`. @return the steps made
WalkSteps walk(const Surface& surface, const HalfEdges& half_edges, const Sides& sides, SurfacePoint& point,
               std::complex<double> dz, int most_triangles = 1000);

/// The corners' vertices of the point's triangle, the nearest first.
std::array<int, 3> nearest_corners(const Surface& surface, const SurfacePoint& point);

/// Returns for each vertex the length of the shortest path of edges from the nearest source (Dijkstra), #V; infinite
/// where there is none.
/// @param lengths #E. Cost: O(n log n).
std::vector<double> graph_distances(const HalfEdges& half_edges, std::span<const double> lengths,
                                    const std::vector<int>& sources);

}  // namespace holomorph::mesh
