// The stars of vertices that become poles: disks of faces, apart from each other and from the boundary.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::mesh {

// Straight walks over a surface, and distances along its edges.

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

/// The faces around one interior vertex in polar coordinates (r, alpha). The radius r is the length of a spoke; alpha
/// sums the corner angles, counter-clockwise from the end of link[0].
struct Star {
  int vertex = 0;
  std::vector<HalfedgeHandle> link;          ///< opposite the vertex in each of its faces, counter-clockwise
  std::vector<int> faces;                    ///< the face of each link half-edge
  std::vector<double> angles;                ///< at the vertex in each face, in radians
  std::vector<std::complex<double>> apexes;  ///< place of the vertex in each face, its link side from 0 to 1
  double total_angle = 0;

  std::size_t size() const { return link.size(); }
};

/// @param lengths #E
/// @param labels #V number of each vertex in messages; empty: its index
/// @throws TopologyError if a vertex has no face, a star touches the boundary or itself, or two stars share a vertex
std::vector<Star> stars(const HalfEdges& half_edges, std::span<const double> lengths, const std::vector<int>& vertices,
                        const std::vector<int>& labels = {});

/// Returns the star of one vertex without checking for overlaps. @throws TopologyError if the vertex has no face, or
/// lies on the boundary
Star star(const HalfEdges& half_edges, std::span<const double> lengths, int vertex,
          const std::vector<int>& labels = {});

/// The vertex, which has a face and does not lie on the boundary, and its neighbours along edges of polygons.
std::vector<int> star_vertices(const Surface& surface, const HalfEdges& half_edges, int vertex);

/// Returns the corners of all polygons at a vertex that has a face, ascending. Two vertices can be poles together if no
/// such corner of one is in the star of the other.
std::vector<int> corners_around(const Surface& surface, const HalfEdges& half_edges, int vertex);

/// Whether `stars` accepts the vertex alone once diagonals are flipped away from it: its neighbours along edges of
/// polygons are distinct and not on the boundary.
bool has_proper_star(const Surface& surface, const HalfEdges& half_edges, int vertex);

/// Like has_proper_star; besides, neither the vertex nor one of these neighbours is marked in `taken` (#V). Marks
/// nothing.
bool has_free_star(const Surface& surface, const HalfEdges& half_edges, int vertex, const std::vector<char>& taken);

/// Marks the vertex and its neighbours along edges of polygons.
void mark_star(const Surface& surface, const HalfEdges& half_edges, int vertex, std::vector<char>& taken);

/// Flips the diagonals of polygons that end at one of the vertices. Then each polygon has one triangle there, and every
/// spoke is an edge of a polygon. Edges keep their indices.
/// @throws TopologyError if two of the vertices are corners of one polygon
void flip_diagonals_away(Surface& surface, const std::vector<int>& vertices, const std::vector<int>& labels = {});

/// Returns about `most` vertices around one, itself among them, the fewest edges away first. @pre the surface is closed
std::vector<int> vertices_around(const HalfEdges& half_edges, int vertex, std::size_t most);

/// Whether two ascending lists have nothing in common.
bool are_apart(const std::vector<int>& a, const std::vector<int>& b);

}  // namespace holomorph::mesh
