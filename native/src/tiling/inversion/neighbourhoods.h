// The vertices around poles.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::tiling {

/// About `most` vertices around one, itself among them, the nearest along edges first. @pre closed
std::vector<int> vertices_around(const mesh::HalfEdges& half_edges, int vertex, std::size_t most);

/// Whether two ascending lists have nothing in common.
bool are_apart(const std::vector<int>& a, const std::vector<int>& b);

}  // namespace holomorph::tiling
