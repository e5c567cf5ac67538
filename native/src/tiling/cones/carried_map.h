// Carries a map from a level of a surface to all of its triangles.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"
#include "tiling/cones/lattice_map.h"
#include "tiling/levels.h"

namespace holomorph::tiling {

/// Carries a map up vertex splits, which copy symmetries: moved corners keep theirs, and each new triangle continues
/// one beside it. So the jumps of the level stay what they are, and its cones stay where they are. A new vertex is
/// placed where its nearest point is on the star that the split opens, or if that flips a triangle, nearer to the
/// vertex that it leaves.
/// @param level of `levels`, with fewer triangles than the surface
/// @return the map of the surface; triangles of a polygon need not continue each other
/// @pre `levels.mesh()` has the surface's triangles. Cost: linear. @throws Cancelled
LatticeMap carried_map(const mesh::Surface& surface, const Levels& levels, const CoarseLevel& level,
                       const TurnLattice& lattice, const LatticeMap& map, Execution& execution);

}  // namespace holomorph::tiling
