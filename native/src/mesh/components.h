// Connected components and boundary loops.
#pragma once

#include <string>
#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// A connected component as a surface of its own, without isolated vertices. The indices grow with the parent's, so
/// the lower vertex of an edge remains the lower one.
struct Component {
  Surface surface;
  std::vector<int> vertex_index, face_index, corner_index;  ///< index of each element in the parent
};

Component component(const Surface& surface, int which, Execution& execution);

/// Returns all components, in their order. Cost: linear, as for a single one.
std::vector<Component> components(const Surface& surface, Execution& execution);

/// Euler characteristic of a connected surface, its isolated vertices not counted.
int euler_characteristic(const Surface& surface);

/// Number of boundary loops of a surface, without building its half-edges.
int boundary_count(const Surface& surface);

/// What a connected surface is up to homeomorphism.
struct TopologicalType {
  int genus = 0, boundary_count = 0;

  bool closed() const { return boundary_count == 0; }
  /// Number of harmonic forms in a family: 2g on a closed surface; with boundary 2g + b - 1, the genus of the double.
  int form_count() const { return 2 * genus + (closed() ? 0 : boundary_count - 1); }
  /// "genus 1 and 2 boundaries"
  std::string text() const;
};

TopologicalType topological_type(const Surface& surface);

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
