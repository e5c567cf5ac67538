// Distances along the edges of a mesh.
#pragma once

#include <span>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// Returns for each vertex the length of the shortest path of edges from the nearest source (Dijkstra), #V; infinite
/// where there is none.
/// @param lengths #E. Cost: O(n log n).
std::vector<double> graph_distances(const HalfEdges& half_edges, std::span<const double> lengths,
                                    const std::vector<int>& sources);

}  // namespace holomorph::mesh
