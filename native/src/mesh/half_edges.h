// Half-edges of a surface of triangles, built and walked by edge index. Two edges may share both ends, and an edge may
// be a loop: doubles and intrinsic surfaces have both.
#pragma once

#include <atomic>
#include <compare>
#include <unordered_map>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "base/workers.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// The links of half-edges: the next one, the vertex at the head and the face on the left.
//
// The names are those of OpenMesh's connectivity kernel. OpenMesh fills its arrays element by element, copies them
// where they could be moved, and finds edges by their ends.

/// The index of an element; -1 names none. Each kind of element has a type of its own, so that no handle of one is
/// taken for one of another.
template <class Element>
class Handle {
 public:
  Handle() = default;
  explicit Handle(int index) : index_(index) {}

  int idx() const { return index_; }
  bool is_valid() const { return index_ >= 0; }
  auto operator<=>(const Handle&) const = default;

 private:
  int index_ = -1;
};

using VertexHandle = Handle<struct Vertex>;
using HalfedgeHandle = Handle<struct Halfedge>;
using EdgeHandle = Handle<struct Edge>;
using FaceHandle = Handle<struct Face>;

/// Half-edge 2e runs along edge e from its lower to its higher vertex, 2e+1 back. After a flip 2e remains the
/// direction of values on e. Triangle t's first half-edge is its side 0. One without a face runs along the boundary,
/// and a boundary vertex keeps the one that leaves it.
class HalfEdges {
 public:
  HalfEdges() = default;
  /// Leaves all links to be set.
  HalfEdges(std::size_t vertices, std::size_t edges, std::size_t faces)
      : vertices_(vertices), faces_(faces), half_edges_(2 * edges) {}
  HalfEdges(HalfEdges&&) = default;
  HalfEdges& operator=(HalfEdges&&) = default;
  /// Copies in parallel. There is no copy constructor: copies are large, and none should be made by accident.
  HalfEdges copy(Workers& workers) const;

  std::size_t n_vertices() const { return vertices_.size(); }
  std::size_t n_edges() const { return half_edges_.size() / 2; }
  std::size_t n_halfedges() const { return half_edges_.size(); }
  std::size_t n_faces() const { return faces_.size(); }

  /// A half-edge that leaves the vertex; invalid at a vertex of no face.
  HalfedgeHandle halfedge_handle(VertexHandle v) const { return HalfedgeHandle(vertices_[v.idx()]); }
  HalfedgeHandle halfedge_handle(FaceHandle f) const { return HalfedgeHandle(faces_[f.idx()]); }
  HalfedgeHandle halfedge_handle(EdgeHandle e, int i) const { return HalfedgeHandle(2 * e.idx() + i); }
  /// The next half-edge around the face, or along the boundary.
  HalfedgeHandle next_halfedge_handle(HalfedgeHandle h) const { return HalfedgeHandle(half_edges_[h.idx()].next); }
  VertexHandle to_vertex_handle(HalfedgeHandle h) const { return VertexHandle(half_edges_[h.idx()].to); }
  FaceHandle face_handle(HalfedgeHandle h) const { return FaceHandle(half_edges_[h.idx()].face); }

  bool is_boundary(HalfedgeHandle h) const { return half_edges_[h.idx()].face < 0; }
  bool is_boundary(EdgeHandle e) const {
    return is_boundary(halfedge_handle(e, 0)) || is_boundary(halfedge_handle(e, 1));
  }
  /// True as well for a vertex of no face.
  bool is_boundary(VertexHandle v) const { return vertices_[v.idx()] < 0 || is_boundary(halfedge_handle(v)); }

  void set_halfedge_handle(VertexHandle v, HalfedgeHandle h) { vertices_[v.idx()] = h.idx(); }
  void set_halfedge_handle(FaceHandle f, HalfedgeHandle h) { faces_[f.idx()] = h.idx(); }
  void set_next_halfedge_handle(HalfedgeHandle h, HalfedgeHandle next) { half_edges_[h.idx()].next = next.idx(); }

  void set_halfedge(HalfedgeHandle h, HalfedgeHandle next, VertexHandle to, FaceHandle f) {
    half_edges_[h.idx()] = {next.idx(), to.idx(), f.idx()};
  }

  /// Makes `h` the half-edge of the vertex, unless it has a lower one. Several threads may do this at one vertex.
  void lower_halfedge_handle(VertexHandle v, HalfedgeHandle h) {
    const std::atomic_ref<int> kept(vertices_[v.idx()]);
    int before = kept.load(std::memory_order_relaxed);
    while ((before < 0 || h.idx() < before) &&
           !kept.compare_exchange_weak(before, h.idx(), std::memory_order_relaxed)) {
    }
  }

  /// Makes `other` the half-edge of the vertex if it has `old`. Several threads may do this at one vertex, each with
  /// its own `old`.
  void replace_halfedge_handle(VertexHandle v, HalfedgeHandle old, HalfedgeHandle other) {
    const std::atomic_ref<int> kept(vertices_[v.idx()]);
    if (kept.load(std::memory_order_relaxed) == old.idx()) kept.store(other.idx(), std::memory_order_relaxed);
  }

  /// Prefetches both half-edges of an edge.
  void prefetch_halfedges(EdgeHandle e) const { prefetch(&half_edges_[2 * e.idx()]); }

 private:
  struct HalfEdge {
    int next, to, face;
  };

  Array<int> vertices_, faces_;
  Array<HalfEdge> half_edges_;
};

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
