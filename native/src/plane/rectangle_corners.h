// Checks or chooses the four corners of a disk that is mapped to a rectangle.
#pragma once

#include <array>
#include <vector>

#include "base/execution.h"
#include "mesh/boundary_loops.h"

namespace holomorph::plane {

/// Side i: the boundary vertices from corner i to the next, both included.
using Sides = std::array<std::vector<int>, 4>;

/// Returns the sides of a disk between four corners.
/// @param corners four vertices on the boundary, in its order, the surface on its left
/// @param labels #V number of each vertex in messages; empty: its index
/// @throws TopologyError for a surface that is not a disk, corners that are repeated, out of range, not on the boundary
/// or not in its order
Sides rectangle_sides(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const std::vector<int>& corners,
                      const std::vector<int>& labels);

/// Returns the triangles all of whose corners lie on one side, ascending. A map that makes the side straight collapses
/// them.
std::vector<int> collapsed_triangles(const mesh::Surface& surface, const Sides& sides);

/// Returns the number of edges of the longest boundary loop.
int boundary_length(const mesh::Surface& surface, Execution& execution);

/// Chooses four corners of a disk that has no clear ones: the boundary vertices nearest to the quarters of its length,
/// from the lowest vertex on.
/// @throws TopologyError for a boundary of three edges
std::vector<int> quarter_corners(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::plane
