// The ends of edges: all that the values of a form on a triangulation need of it.
#pragma once

#include "mesh/half_edges.h"

namespace holomorph::mesh {

/// The ends of the edges of a surface, or of a triangulation of it, which outlives this.
class EdgeEnds {
 public:
  /// Implicit: functions of edge ends take a surface or half-edges.
  EdgeEnds(const Surface& surface) : pairs_(&surface.edges), vertex_count_(surface.vertex_count) {}
  EdgeEnds(const HalfEdges& half_edges)
      : half_edges_(&half_edges), vertex_count_(static_cast<int>(half_edges.n_vertices())) {}

  int vertex_count() const { return vertex_count_; }
  int edge_count() const { return static_cast<int>(pairs_ ? pairs_->size() : half_edges_->n_edges()); }
  /// The value of a form on edge e is that along half-edge 2e, from tail to head.
  int tail(int e) const { return pairs_ ? (*pairs_)[e][0] : to_vertex(*half_edges_, HalfedgeHandle(2 * e + 1)); }
  int head(int e) const { return pairs_ ? (*pairs_)[e][1] : to_vertex(*half_edges_, HalfedgeHandle(2 * e)); }

 private:
  const Array<Pair>* pairs_ = nullptr;
  const HalfEdges* half_edges_ = nullptr;
  int vertex_count_;
};

inline int from_vertex(const EdgeEnds& ends, HalfedgeHandle h) {
  return sign(h) > 0 ? ends.tail(edge_of(h)) : ends.head(edge_of(h));
}

}  // namespace holomorph::mesh
