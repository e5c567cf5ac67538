#include "mesh/half_edges.h"

#include <string>
#include <unordered_map>

#include "base/chunks.h"
#include "base/errors.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

void set_ends(HalfEdges& mesh, const Surface& surface, Workers& workers) {
  for_rows(workers, static_cast<int>(surface.edges.size()), [&](int e) {
    for (const int i : {0, 1}) {
      const HalfedgeHandle h(2 * e + i);
      mesh.set_next_halfedge_handle(h, HalfedgeHandle());
      mesh.set_vertex_handle(h, VertexHandle(surface.edges[e][1 - i]));
      mesh.set_face_handle(h, FaceHandle());
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

// A side runs along its edge if it starts at the lower vertex. At a loop both sides do: the first one runs along.
class Sides {
 public:
  explicit Sides(const Surface& surface) : surface_(surface), first_of_loop_(first_sides_of_loops(surface)) {}

  HalfedgeHandle half_edge(int triangle, int side) const {
    const Triple& v = surface_.triangles[triangle];
    const int edge = surface_.triangle_edges[triangle][side], from = v[side], to = v[(side + 1) % 3];
    const bool along = from != to ? from < to : first_of_loop_.at(edge) == 3 * triangle + side;
    return HalfedgeHandle(2 * edge + (along ? 0 : 1));
  }

 private:
  const Surface& surface_;
  std::unordered_map<int, int> first_of_loop_;
};

// All links of the triangles but those of the vertices write where no other triangle does. Those of the vertices are
// left to one thread, as one long task beside the others.
void link_triangles(HalfEdges& mesh, const Surface& surface, Workers& workers) {
  const Sides sides(surface);
  const int count = static_cast<int>(surface.triangles.size());
  const auto link_vertices = [&] {
    for (int v = 0; v < surface.vertex_count; ++v) mesh.set_halfedge_handle(VertexHandle(v), HalfedgeHandle());
    for (int t = 0; t < count; ++t) {
      for (int i = 0; i < 3; ++i)
        mesh.set_halfedge_handle(VertexHandle(surface.triangles[t][i]), sides.half_edge(t, i));
    }
  };
  const auto link = [&](int t) {
    const HalfedgeHandle side[3] = {sides.half_edge(t, 0), sides.half_edge(t, 1), sides.half_edge(t, 2)};
    for (int i = 0; i < 3; ++i) {
      mesh.set_face_handle(side[i], FaceHandle(t));
      mesh.set_next_halfedge_handle(side[i], side[(i + 1) % 3]);
    }
    mesh.set_halfedge_handle(FaceHandle(t), side[0]);
  };
  workers.run(1 + chunk_count(count), [&](int, int task) {
    if (task == 0) return link_vertices();
    for (int t = (task - 1) * kChunk, end = std::min(t + kChunk, count); t < end; ++t) link(t);
  });
}

[[noreturn]] void refuse(int vertex) {
  throw InvalidMesh("vertex " + to_string(vertex) + " is non-manifold: two fans of faces touch there");
}

// A boundary half-edge is followed by the boundary half-edge that leaves its end. A boundary vertex keeps that one.
void link_boundary(HalfEdges& mesh) {
  std::vector<HalfedgeHandle> leaving;
  std::vector<int> at(mesh.n_vertices(), -1);
  for (int i = 0; i < static_cast<int>(mesh.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (!mesh.is_boundary(h)) continue;
    const int v = from_vertex(mesh, h);
    if (at[v] >= 0) refuse(v);
    at[v] = static_cast<int>(leaving.size());
    leaving.push_back(h);
    mesh.set_halfedge_handle(VertexHandle(v), h);
  }
  for (const HalfedgeHandle h : leaving) mesh.set_next_halfedge_handle(h, leaving[at[to_vertex(mesh, h)]]);
}

// The half-edges that leave a vertex in the fan of the one it keeps.
int fan_size(const HalfEdges& mesh, int vertex) {
  const HalfedgeHandle start = mesh.halfedge_handle(VertexHandle(vertex));
  if (!start.is_valid()) return 0;
  int met = 0;
  HalfedgeHandle h = start;
  do {
    ++met;
    h = next(mesh, opposite(h));
  } while (h != start);
  return met;
}

}  // namespace

HalfEdges half_edges(const Surface& surface, Progress& progress) {
  Workers workers;
  HalfEdges mesh(surface.vertex_count, surface.edges.size(), surface.triangles.size());
  set_ends(mesh, surface, workers);
  progress.report(0.3);
  link_triangles(mesh, surface, workers);
  progress.report(0.9);
  if (mesh.n_halfedges() > 3 * mesh.n_faces()) link_boundary(mesh);
  progress.report(1.0);
  return mesh;
}

// Every half-edge is in one fan, so that the fans of the vertices are all there are if together they have them all.
void refuse_pinched_vertices(const HalfEdges& mesh) {
  const int n = static_cast<int>(mesh.n_vertices());
  Workers workers;
  const auto met = sum_over_rows(workers, n, std::size_t{0},
                                 [&](int v, std::size_t& sum) { sum += static_cast<std::size_t>(fan_size(mesh, v)); });
  if (met == mesh.n_halfedges()) return;
  std::vector<int> leaving(n, 0);
  for (int i = 0; i < static_cast<int>(mesh.n_halfedges()); ++i) ++leaving[from_vertex(mesh, HalfedgeHandle(i))];
  for (int v = 0; v < n; ++v) {
    if (fan_size(mesh, v) != leaving[v]) refuse(v);
  }
}

void flip_links(HalfEdges& mesh, EdgeHandle e) {
  const HalfedgeHandle a0 = mesh.halfedge_handle(e, 0), b0 = mesh.halfedge_handle(e, 1);
  const HalfedgeHandle a1 = next(mesh, a0), a2 = next(mesh, a1), b1 = next(mesh, b0), b2 = next(mesh, b1);
  const VertexHandle head = mesh.to_vertex_handle(a0), tail = mesh.to_vertex_handle(b0);
  const VertexHandle a_apex = mesh.to_vertex_handle(a1), b_apex = mesh.to_vertex_handle(b1);
  const FaceHandle fa = mesh.face_handle(a0), fb = mesh.face_handle(b0);
  mesh.replace_halfedge_handle(head, b0, a1);
  mesh.replace_halfedge_handle(tail, a0, b1);
  // New triangles: fa = a0 a2 b1 with a0 from b's apex to a's, and fb = b0 b2 a1.
  mesh.set_vertex_handle(a0, a_apex);
  mesh.set_vertex_handle(b0, b_apex);
  const auto link = [&](HalfedgeHandle x, HalfedgeHandle y, HalfedgeHandle z, FaceHandle f) {
    mesh.set_next_halfedge_handle(x, y);
    mesh.set_next_halfedge_handle(y, z);
    mesh.set_next_halfedge_handle(z, x);
    for (const HalfedgeHandle h : {x, y, z}) mesh.set_face_handle(h, f);
    mesh.set_halfedge_handle(f, x);
  };
  link(a0, a2, b1, fa);
  link(b0, b2, a1, fb);
}

int boundary_count(const HalfEdges& mesh) {
  std::vector<char> met(mesh.n_halfedges(), 0);
  int loops = 0;
  for (int i = 0; i < static_cast<int>(mesh.n_halfedges()); ++i) {
    HalfedgeHandle h(i);
    if (mesh.face_handle(h).is_valid() || met[i]) continue;
    ++loops;
    for (; !met[h.idx()]; h = next(mesh, h)) met[h.idx()] = 1;
  }
  return loops;
}

}  // namespace holomorph::mesh
