// The double of a surface with boundary: two copies glued along the boundary (paper § 8).
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// The first copy keeps the numbers of its vertices, edges and faces. The second one has the other orientation. It
/// shares the vertices and edges of the boundary. Its others come after those of the first, in their order. Everything
/// is matched by half-edges, never by pairs of vertices, so that chords are no exception.
struct DoubleCover {
  HalfEdges half_edges;
  std::vector<int> dual_vertex;  ///< #V of the surface: the same vertex in the second copy
  std::vector<HalfedgeHandle> first,
      second;  ///< #half-edges of the surface that have a face: the same one in each copy
};

/// @pre orientable, with boundary. Cost: linear.
DoubleCover double_cover(const HalfEdges& half_edges, Execution& execution);

}  // namespace holomorph::mesh
