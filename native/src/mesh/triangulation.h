// Cutting one polygon into triangles.
#pragma once

#include <array>
#include <vector>

namespace holomorph::mesh {

/// Cuts a polygon into triangles: triples of its local corners 0 .. n-1, each in the polygon's own order (i < j < k).
/// Minimises the sum of (a^2 + b^2 + c^2) / area over the triangles. This is the Delaunay triangulation where the
/// polygon is planar and convex (Musin, Properties of the Delaunay triangulation, 1997, doi:10.1145/262839.263061).
/// Triangles that lie against the polygon's vector area cost more than any that do not. Avoids triangles whose corners
/// all lie on one boundary loop, where other diagonals have fewer of them. Maps that make the loop straight would
/// collapse these.
/// @param loops n boundary loops of the corners, -1 in the interior; empty: no corner is on the boundary
/// Exact up to 64 corners, by dynamic programming, O(n^3). Above, it cuts off the best ear repeatedly, O(n log n).
std::vector<std::array<int, 3>> triangulate_polygon(const std::vector<std::array<double, 3>>& corners,
                                                    const std::vector<int>& loops = {});

}  // namespace holomorph::mesh
