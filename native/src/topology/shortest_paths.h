// The tree T of shortest paths of a fundamental domain, its root chosen by the caller.
#pragma once

#include <vector>

#include "base/execution.h"
#include "topology/domain.h"

namespace holomorph::topology {

/// Fills in to_parent_vertex, vertex_rank and the gaps of a domain whose boundary is known.
/// @return #V distances from the root along T
/// Dijkstra along edges of polygons. The first vertex of a star that is settled settles its centre and link through
/// the spokes. So does the first vertex of a boundary loop, at no cost, because the surface need not be cut along it.
/// Cost: O(n log m), with m the few vertices of a bucket.
Array<double> grow_shortest_paths(const mesh::Surface& surface, const HalfEdges& half_edges,
                                  const std::vector<mesh::Star>& stars, int root, FundamentalDomain& domain,
                                  Execution& execution);

}  // namespace holomorph::topology
