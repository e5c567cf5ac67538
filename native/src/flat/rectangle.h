// Maps to rectangles.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "flat/dirichlet_problem.h"
#include "mesh/components.h"
#include "mesh/surface.h"

namespace holomorph::flat {

// Checks or chooses the four corners of a disk that is mapped to a rectangle.

/// Side i: the boundary vertices from corner i to the next, both included.
using FourSides = std::array<std::vector<int>, 4>;

/// Returns the sides of a disk between four corners.
/// @param corners four vertices on the boundary, in its order, the surface on its left
/// @param labels #V number of each vertex in messages; empty: its index
/// @throws TopologyError for a surface that is not a disk, corners that are repeated, out of range, not on the boundary
/// or not in its order
FourSides rectangle_sides(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                          const std::vector<int>& corners, const std::vector<int>& labels);

/// Returns the triangles all of whose corners lie on one side, ascending. A map that makes the side straight collapses
/// them.
std::vector<int> collapsed_triangles(const mesh::Surface& surface, const FourSides& sides);

/// Returns the number of edges of the longest boundary loop.
int boundary_length(const mesh::Surface& surface, Execution& execution);

/// Chooses four corners of a disk that has no clear ones: the boundary vertices nearest to the quarters of its length,
/// from the lowest vertex on.
/// @throws TopologyError for a boundary of three edges
std::vector<int> quarter_corners(const mesh::Surface& surface, Execution& execution);

/// Finds the four corners of a disk, or nothing where they are not clear. They follow the boundary, the surface on its
/// left, from the lowest vertex on.
///
/// They are clear where the boundary turns by more than 45 degrees at exactly four places, and back at none. The turn
/// at a vertex is its exterior angle. Where these are rough or the corners round, directions are averaged over a part
/// of the boundary's length. The turn at a place is then the mean direction after it less the mean direction before it.
/// Parts from 1/256 to 1/16 are tried, and the first that shows four corners is taken. Each corner has to turn by 60
/// degrees in that case. On terrain, heights make exterior angles meaningless. There the boundary's projection to its
/// least-squares plane is searched in the same way, and the surface itself has to turn at the corners, too. (The rim of
/// a tray is a rectangle, but a conformal map of the tray has no corners there.)
///
/// No length scale enters: 512-gons, stadiums, hexagons and L shapes have none.
std::optional<std::vector<int>> clear_corners(const mesh::Surface& surface, Execution& execution);

/// Corners c0 .. c3 on the boundary, the surface on its left. u is 0 on the side from c3 to c0 and 1 on that from c1 to
/// c2. v is 0 from c0 to c1 and 1 from c2 to c3. The other sides are natural. Each has the least energy under its own
/// conditions. So (u, m v) is the conformal map to a rectangle of width 1 and height m, up to the discretisation. Its
/// sides are exactly straight.
///
/// 1 / E(v) <= m <= E(u), E(f) = f . L f: both are energies of admissible functions of the polyhedral surface, on its
/// intrinsic Delaunay triangulation. The modulus is their geometric mean.
///
/// The rectangle has the width 1 and the height `modulus`, corner 0 at the origin, corner 1 at 1.
/// @param corners four vertices
/// @param labels #V number of each vertex in messages; empty: its index
/// @throws TopologyError for a surface that is not a disk, and for corners that are repeated, out of range, not on the
/// boundary or not in its order. SolverError; Cancelled
/// Cost: four solves, of four matrices; two where no edge is flipped.
PlaneMap rectangle_map(const mesh::Surface& surface, const std::vector<int>& corners, const std::vector<int>& labels,
                       const Options& options, Execution& execution);

}  // namespace holomorph::flat
