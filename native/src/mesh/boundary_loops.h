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

/// Returns the same loops in another order. @param number #loops the new number of each
BoundaryLoops renumbered(const BoundaryLoops& boundary, const std::vector<int>& number);

/// Returns the vertices of all loops, ascending; the same for every triangulation of the surface.
std::vector<int> boundary_vertices(const HalfEdges& half_edges);
std::vector<int> boundary_vertices(const BoundaryLoops& boundary);

/// Returns the triangles all of whose corners lie on one loop, ascending. Every map that makes the loop straight
/// collapses them.
std::vector<int> triangles_on_one_loop(const Surface& surface, const BoundaryLoops& boundary);

}  // namespace holomorph::mesh
