// The boundary loops of a surface, in a fixed order.
#pragma once

#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::mesh {

struct BoundaryLoops {
  /// Loop 0 is the longest; of loops equally long to 1e-9 the one with the lowest vertex. The others follow by their
  /// lowest vertex, at which each loop starts. Consecutive half-edges without a face: the hole on their left, the
  /// surface on their right.
  std::vector<std::vector<HalfedgeHandle>> loops;
  std::vector<int> loop_of_vertex;  ///< #V; -1 in the interior

  int count() const { return static_cast<int>(loops.size()); }
};

BoundaryLoops boundary_loops(const Surface& surface, const HalfEdges& half_edges);

/// The same loops in another order. @param number #loops the new number of each
BoundaryLoops renumbered(const BoundaryLoops& boundary, const std::vector<int>& number);

/// The vertices of all loops, ascending; those of any triangulation of the surface.
std::vector<int> boundary_vertices(const HalfEdges& half_edges);
std::vector<int> boundary_vertices(const BoundaryLoops& boundary);

/// Triangles all of whose corners lie on one loop, ascending: every map that makes the loop straight collapses them.
std::vector<int> triangles_on_one_loop(const Surface& surface, const BoundaryLoops& boundary);

}  // namespace holomorph::mesh
