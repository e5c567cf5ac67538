// The vertices around poles.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::tiling {

/// Returns about `most` vertices around one, itself among them, the fewest edges away first. @pre the surface is closed
std::vector<int> vertices_around(const mesh::HalfEdges& half_edges, int vertex, std::size_t most);

/// Whether two ascending lists have nothing in common.
bool are_apart(const std::vector<int>& a, const std::vector<int>& b);

}  // namespace holomorph::tiling
