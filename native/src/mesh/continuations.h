// Which faces at an edge with many continue each other best.
#pragma once

#include <array>
#include <vector>

#include "mesh/polygons.h"

namespace holomorph::mesh {

/// Returns the pairs of sides that meet at an edge, over all edges, the best first. Pairs that are oriented alike come
/// before others. Then pairs are sorted by the angle between their faces (flat first), convex before concave, and by
/// index.
/// @param label #C; the sides of an edge run between the same two
/// @param reversed #F 1 where the polygon is to be read in reverse
/// @param edges the sides of each edge
/// Cost: the square of the number of sides of an edge.
std::vector<std::array<int, 2>> continuations(const Polygons& polygons, const std::vector<int>& label,
                                              const std::vector<char>& reversed,
                                              const std::vector<std::vector<int>>& edges);

}  // namespace holomorph::mesh
