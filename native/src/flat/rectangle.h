// Maps to rectangles.
#pragma once

#include <vector>

#include "base/execution.h"
#include "flat/dirichlet_problem.h"
#include "mesh/surface.h"

namespace holomorph::flat {

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
