// Disks with three boundary edges and no vertex for a centre.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"
#include "plane/plane_map.h"

namespace holomorph::plane {

/// Computes the harmonic map to the triangle with the lengths of the three boundary edges, scaled so that its longest
/// side is 1. It is counter-clockwise, with the lowest boundary vertex at 0 and the next one on the real axis. A single
/// triangle is mapped to itself.
/// @pre a disk
/// @throws TopologyError for a boundary of more than three edges; SolverError; Cancelled
PlaneMap triangle_map(const mesh::Surface& surface, const Options& options, Execution& execution);

}  // namespace holomorph::plane
