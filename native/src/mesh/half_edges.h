// Half-edges of a surface of triangles, built and walked by edge index. Two edges may share both ends, and an edge may
// be a loop: doubles and intrinsic surfaces have both.
#pragma once

#include <unordered_map>

#include "base/execution.h"
#include "mesh/half_edge_links.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// @throws InvalidMesh for a vertex at which two fans of faces touch on the boundary
/// Cost: linear, in parallel.
HalfEdges half_edges(const Surface& surface, Execution& execution);

/// Finds the half-edge of each side of a triangle without links.
class Sides {
 public:
  explicit Sides(const Surface& surface);

  /// Side i from corner i to corner i + 1. It runs along its edge if it starts at the lower vertex. At a loop both
  /// sides do: the first one runs along.
  HalfedgeHandle operator()(int triangle, int i) const {
    const Triple& v = surface_.triangles[triangle];
    const int edge = surface_.triangle_edges[triangle][i], from = v[i], to = v[(i + 1) % 3];
    const bool along = from != to ? from < to : first_of_loop_.at(edge) == 3 * triangle + i;
    return HalfedgeHandle(2 * edge + (along ? 0 : 1));
  }

 private:
  const Surface& surface_;
  std::unordered_map<int, int> first_of_loop_;  // the first side, 3 t + i, of each edge from a vertex to itself
};

/// @throws InvalidMesh for the first vertex at which two fans of faces touch
void refuse_pinched_vertices(const HalfEdges& half_edges, Workers& workers);

/// +1 where `h` runs along its edge, -1 where it runs back.
inline int sign(HalfedgeHandle h) { return h.idx() & 1 ? -1 : 1; }
inline int edge_of(HalfedgeHandle h) { return h.idx() >> 1; }
inline HalfedgeHandle opposite(HalfedgeHandle h) { return HalfedgeHandle(h.idx() ^ 1); }
inline int from_vertex(const HalfEdges& half_edges, HalfedgeHandle h) {
  return half_edges.to_vertex_handle(opposite(h)).idx();
}
inline int to_vertex(const HalfEdges& half_edges, HalfedgeHandle h) { return half_edges.to_vertex_handle(h).idx(); }
inline int face_of(const HalfEdges& half_edges, HalfedgeHandle h) { return half_edges.face_handle(h).idx(); }
/// The next half-edge around the face. In a triangle, the next of the next is the previous one.
inline HalfedgeHandle next(const HalfEdges& half_edges, HalfedgeHandle h) { return half_edges.next_halfedge_handle(h); }
/// Whether `h` has the lowest number in its triangle: true for one half-edge of each face. @pre `h` has a face
inline bool is_first_of_face(const HalfEdges& half_edges, HalfedgeHandle h) {
  const HalfedgeHandle after = next(half_edges, h);
  return h < after && h < next(half_edges, after);
}

/// Flips edge e inside the quadrilateral of its two triangles, links only. @pre two different faces at e.
/// Threads may flip edges of different faces.
void flip_links(HalfEdges& half_edges, EdgeHandle e);

/// Number of boundary loops.
int boundary_count(const HalfEdges& half_edges);

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
