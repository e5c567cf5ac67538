#include "mesh/half_edges.h"

#include <string>

#include "base/errors.h"
#include "base/workers.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

// Prefetch distance, in triangles: their half-edges may lie anywhere.
constexpr int kEdgesAhead = 24;

// Each vertex keeps the lowest half-edge that leaves it.
void link_vertices(HalfEdges& half_edges, const Surface& surface, Workers& workers) {
  for_rows(workers, surface.vertex_count,
           [&](int v) { half_edges.set_halfedge_handle(VertexHandle(v), HalfedgeHandle()); });
  for_rows(workers, static_cast<int>(surface.edges.size()), [&](int e) {
    for (const int i : {0, 1})
      half_edges.lower_halfedge_handle(VertexHandle(surface.edges[e][i]), HalfedgeHandle(2 * e + i));
  });
}

// Links half-edges as if none had a face; those with a face are linked later.
void set_outside(HalfEdges& half_edges, const Surface& surface, Workers& workers) {
  for_rows(workers, static_cast<int>(surface.edges.size()), [&](int e) {
    for (const int i : {0, 1}) {
      const VertexHandle to(surface.edges[e][1 - i]);
      half_edges.set_halfedge(HalfedgeHandle(2 * e + i), HalfedgeHandle(), to, FaceHandle());
    }
  });
}

// The first side, 3 t + i, of each edge from a vertex to itself. Only triangles of intrinsic surfaces have any.
std::unordered_map<int, int> first_sides_of_loops(const Surface& surface) {
  std::unordered_map<int, int> first;
  if (!surface.intrinsic()) return first;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const Triple& v = surface.triangles[t];
    for (int i = 0; i < 3; ++i) {
      if (v[i] == v[(i + 1) % 3]) first.try_emplace(surface.triangle_edges[t][i], 3 * t + i);
    }
  }
  return first;
}

// In parallel: no two triangles write to the same place.
void link_triangles(HalfEdges& half_edges, const Surface& surface, Workers& workers) {
  const Sides sides(surface);
  const int count = static_cast<int>(surface.triangles.size());
  for_rows(workers, count, [&](int t) {
    for (const int e : surface.triangle_edges[std::min(t + kEdgesAhead, count - 1)])
      half_edges.prefetch_halfedges(EdgeHandle(e));
    const Triple& vertices = surface.triangles[t];
    const HalfedgeHandle side[3] = {sides(t, 0), sides(t, 1), sides(t, 2)};
    for (int i = 0; i < 3; ++i) {
      const int after = (i + 1) % 3;
      half_edges.set_halfedge(side[i], side[after], VertexHandle(vertices[after]), FaceHandle(t));
    }
    half_edges.set_halfedge_handle(FaceHandle(t), side[0]);
  });
}

[[noreturn]] void refuse_vertex(int vertex) {
  throw InvalidMesh("vertex " + to_string(vertex) + " is non-manifold: two fans of faces touch there");
}

// A boundary half-edge is followed by the boundary half-edge that leaves its end. A boundary vertex keeps that one.
void link_boundary(HalfEdges& half_edges) {
  std::vector<HalfedgeHandle> leaving;
  std::vector<int> at(half_edges.n_vertices(), -1);
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (!half_edges.is_boundary(h)) continue;
    const int v = from_vertex(half_edges, h);
    if (at[v] >= 0) refuse_vertex(v);
    at[v] = static_cast<int>(leaving.size());
    leaving.push_back(h);
    half_edges.set_halfedge_handle(VertexHandle(v), h);
  }
  for (const HalfedgeHandle h : leaving) half_edges.set_next_halfedge_handle(h, leaving[at[to_vertex(half_edges, h)]]);
}

// The half-edges that leave a vertex in the fan of the one it keeps.
int fan_size(const HalfEdges& half_edges, int vertex) {
  const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(vertex));
  if (!start.is_valid()) return 0;
  int size = 0;
  HalfedgeHandle h = start;
  do {
    ++size;
    h = next(half_edges, opposite(h));
  } while (h != start);
  return size;
}

}  // namespace

Sides::Sides(const Surface& surface) : surface_(surface), first_of_loop_(first_sides_of_loops(surface)) {}

HalfEdges half_edges(const Surface& surface, Execution& execution) {
  Workers& workers = execution.workers();
  HalfEdges half_edges(surface.vertex_count, surface.edges.size(), surface.triangles.size());
  const bool closed = half_edges.n_halfedges() == 3 * half_edges.n_faces();
  link_vertices(half_edges, surface, workers);
  execution.report(0.2);
  if (!closed) set_outside(half_edges, surface, workers);
  link_triangles(half_edges, surface, workers);
  execution.report(0.9);
  if (!closed) link_boundary(half_edges);
  execution.report(1.0);
  return half_edges;
}

// Each half-edge is in one fan: if the vertices' fans have all half-edges, no vertex has a second fan.
void refuse_pinched_vertices(const HalfEdges& half_edges, Workers& workers) {
  const int n = static_cast<int>(half_edges.n_vertices());
  const auto in_fans = sum_over_rows(workers, n, std::size_t{0}, [&](int v, std::size_t& sum) {
    sum += static_cast<std::size_t>(fan_size(half_edges, v));
  });
  if (in_fans == half_edges.n_halfedges()) return;
  std::vector<int> leaving(n, 0);
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i)
    ++leaving[from_vertex(half_edges, HalfedgeHandle(i))];
  for (int v = 0; v < n; ++v) {
    if (fan_size(half_edges, v) != leaving[v]) refuse_vertex(v);
  }
}

HalfEdges HalfEdges::copy(Workers& workers) const {
  HalfEdges result(n_vertices(), n_edges(), n_faces());
  const auto copy_rows = [&workers](const auto& from, auto& to) {
    for_rows(workers, static_cast<int>(from.size()), [&](int i) { to[i] = from[i]; });
  };
  copy_rows(half_edges_, result.half_edges_);
  copy_rows(faces_, result.faces_);
  copy_rows(vertices_, result.vertices_);
  return result;
}

void flip_links(HalfEdges& half_edges, EdgeHandle e) {
  const HalfedgeHandle a0 = half_edges.halfedge_handle(e, 0), b0 = half_edges.halfedge_handle(e, 1);
  const HalfedgeHandle a1 = next(half_edges, a0), a2 = next(half_edges, a1), b1 = next(half_edges, b0),
                       b2 = next(half_edges, b1);
  const VertexHandle head = half_edges.to_vertex_handle(a0), tail = half_edges.to_vertex_handle(b0);
  const VertexHandle a_apex = half_edges.to_vertex_handle(a1), b_apex = half_edges.to_vertex_handle(b1);
  const FaceHandle fa = half_edges.face_handle(a0), fb = half_edges.face_handle(b0);
  half_edges.replace_halfedge_handle(head, b0, a1);
  half_edges.replace_halfedge_handle(tail, a0, b1);
  // New triangles: fa = a0 a2 b1 with a0 from b's apex to a's, and fb = b0 b2 a1.
  half_edges.set_halfedge(a0, a2, a_apex, fa);
  half_edges.set_halfedge(a2, b1, tail, fa);
  half_edges.set_halfedge(b1, a0, b_apex, fa);
  half_edges.set_halfedge_handle(fa, a0);
  half_edges.set_halfedge(b0, b2, b_apex, fb);
  half_edges.set_halfedge(b2, a1, head, fb);
  half_edges.set_halfedge(a1, b0, a_apex, fb);
  half_edges.set_halfedge_handle(fb, b0);
}

int boundary_count(const HalfEdges& half_edges) {
  std::vector<char> visited(half_edges.n_halfedges(), 0);
  int loops = 0;
  for (int i = 0; i < static_cast<int>(half_edges.n_halfedges()); ++i) {
    HalfedgeHandle h(i);
    if (half_edges.face_handle(h).is_valid() || visited[i]) continue;
    ++loops;
    for (; !visited[h.idx()]; h = next(half_edges, h)) visited[h.idx()] = 1;
  }
  return loops;
}

}  // namespace holomorph::mesh
