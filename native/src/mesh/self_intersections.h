// Self-intersections of a mesh.
#pragma once

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// The pairs of triangles, the lower number first and in that order, of which a side of one goes through the other by
/// more than rounding. Two triangles that share a vertex can cross; two that share a side are skipped. Triangles that
/// only touch, or lie in one plane, do not cross.
/// Cost: O(#T log #T) and the pairs that are near each other, in parallel; the same at any number of threads.
std::vector<Pair> self_intersections(const std::vector<std::array<double, 3>>& vertices,
                                     const std::vector<Triple>& triangles, Execution& execution);

}  // namespace holomorph::mesh
