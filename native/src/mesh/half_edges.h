// Half-edges of a surface of triangles, built and walked by edge index: two edges may share both ends, and doubles and
// intrinsic surfaces have such edges, and loops.
//
// The handles and the names are those of OpenMesh's connectivity kernel. Its arrays are not: they are filled element by
// element, copied where they are moved, and its faces and flips look edges up by their ends.
#pragma once

#include <OpenMesh/Core/Mesh/Handles.hh>
#include <atomic>

#include "base/page_allocator.h"
#include "base/progress.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Half-edge 2e runs along edge e from its lower to its higher vertex, 2e+1 back; after a flip 2e is still the
/// direction in which a value on e is meant. Triangle t's first half-edge is its side 0. One without a face runs along
/// the boundary, and a boundary vertex keeps the one that leaves it.
class HalfEdges {
 public:
  HalfEdges() = default;
  /// Without links: every one of them is still to be set.
  HalfEdges(std::size_t vertices, std::size_t edges, std::size_t faces)
      : vertices_(vertices), faces_(faces), half_edges_(2 * edges) {}

  std::size_t n_vertices() const { return vertices_.size(); }
  std::size_t n_edges() const { return half_edges_.size() / 2; }
  std::size_t n_halfedges() const { return half_edges_.size(); }
  std::size_t n_faces() const { return faces_.size(); }

  /// One that leaves the vertex; invalid at a vertex of no face.
  HalfedgeHandle halfedge_handle(VertexHandle v) const { return HalfedgeHandle(vertices_[v.idx()]); }
  HalfedgeHandle halfedge_handle(FaceHandle f) const { return HalfedgeHandle(faces_[f.idx()]); }
  HalfedgeHandle halfedge_handle(EdgeHandle e, int i) const { return HalfedgeHandle(2 * e.idx() + i); }
  /// The next one around the face, or along the boundary.
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
  void set_vertex_handle(HalfedgeHandle h, VertexHandle to) { half_edges_[h.idx()].to = to.idx(); }
  void set_face_handle(HalfedgeHandle h, FaceHandle f) { half_edges_[h.idx()].face = f.idx(); }

  /// Where the vertex has `old`, it has `other` from now on. Threads may do this at one vertex, each with its own
  /// `old`.
  void replace_halfedge_handle(VertexHandle v, HalfedgeHandle old, HalfedgeHandle other) {
    const std::atomic_ref<int> kept(vertices_[v.idx()]);
    if (kept.load(std::memory_order_relaxed) == old.idx()) kept.store(other.idx(), std::memory_order_relaxed);
  }

 private:
  struct HalfEdge {
    int next, to, face;
  };

  Array<int> vertices_, faces_;
  Array<HalfEdge> half_edges_;
};

/// @throws InvalidMesh for a vertex at which two fans of faces touch on the boundary
/// Cost: linear, in parallel.
HalfEdges half_edges(const Surface& surface, Progress& progress);

/// @throws InvalidMesh for the first vertex at which two fans of faces touch
void refuse_pinched_vertices(const HalfEdges& mesh);

/// +1 where `h` runs along its edge, -1 where it runs back.
inline int sign(HalfedgeHandle h) { return h.idx() & 1 ? -1 : 1; }
inline int edge_of(HalfedgeHandle h) { return h.idx() >> 1; }
inline HalfedgeHandle opposite(HalfedgeHandle h) { return HalfedgeHandle(h.idx() ^ 1); }
inline int from_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(opposite(h)).idx(); }
inline int to_vertex(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.to_vertex_handle(h).idx(); }
inline int face_of(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.face_handle(h).idx(); }
/// The next half-edge around the face, and the one after it, which is the one before.
inline HalfedgeHandle next(const HalfEdges& mesh, HalfedgeHandle h) { return mesh.next_halfedge_handle(h); }
/// Whether `h`, which has a face, is the one of lowest number there: every face has one such.
inline bool is_first_of_face(const HalfEdges& mesh, HalfedgeHandle h) {
  const HalfedgeHandle after = next(mesh, h);
  return h < after && h < next(mesh, after);
}

/// Turns edge e inside the quadrilateral of its two triangles, links only. @pre two different faces at e.
/// Threads may turn edges of different faces.
void flip_links(HalfEdges& mesh, EdgeHandle e);

/// Number of boundary loops.
int boundary_count(const HalfEdges& mesh);

}  // namespace holomorph::mesh
