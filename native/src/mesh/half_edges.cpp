#include "mesh/half_edges.h"

#include <string>

#include "base/errors.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

// A side runs along its edge if it starts at the lower vertex. At a loop both sides do: the first one met runs along.
HalfedgeHandle half_edge_of_side(const Surface& surface, int triangle, int side, std::vector<char>& loop_met) {
  const int edge = surface.triangle_edges[triangle][side];
  const auto [lower, higher] = surface.edges[edge];
  const bool along = lower != higher ? surface.triangles[triangle][side] == lower : !std::exchange(loop_met[edge], 1);
  return HalfedgeHandle(2 * edge + (along ? 0 : 1));
}

void link_triangles(HalfEdges& mesh, const Surface& surface, Progress& progress) {
  std::vector<char> loop_met(surface.edges.size(), 0);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    progress.step(t, surface.triangles.size(), 0.3, 0.6);
    const FaceHandle f = mesh.new_face();
    HalfedgeHandle side[3];
    for (int i = 0; i < 3; ++i) side[i] = half_edge_of_side(surface, t, i, loop_met);
    for (int i = 0; i < 3; ++i) {
      mesh.set_face_handle(side[i], f);
      mesh.set_next_halfedge_handle(side[i], side[(i + 1) % 3]);
      mesh.set_halfedge_handle(VertexHandle(surface.triangles[t][i]), side[i]);
    }
    mesh.set_halfedge_handle(f, side[0]);
  }
}

// A boundary half-edge is followed by the boundary half-edge that leaves its end. A boundary vertex keeps that one.
void link_boundary(HalfEdges& mesh) {
  std::vector<HalfedgeHandle> leaving;
  std::vector<int> at(mesh.n_vertices(), -1);
  for (int i = 0; i < static_cast<int>(mesh.n_halfedges()); ++i) {
    const HalfedgeHandle h(i);
    if (mesh.face_handle(h).is_valid()) continue;
    const int v = from_vertex(mesh, h);
    if (at[v] >= 0) throw InvalidMesh("vertex " + to_string(v) + " is non-manifold: two fans of faces touch there");
    at[v] = static_cast<int>(leaving.size());
    leaving.push_back(h);
    mesh.set_halfedge_handle(VertexHandle(v), h);
  }
  for (const HalfedgeHandle h : leaving) {
    const HalfedgeHandle after = leaving[at[to_vertex(mesh, h)]];
    mesh.set_next_halfedge_handle(h, after);
  }
}

// The walk around a vertex must meet all half-edges that leave it.
void check_vertices(const HalfEdges& mesh, Progress& progress) {
  std::vector<int> leaving(mesh.n_vertices(), 0);
  for (int i = 0; i < static_cast<int>(mesh.n_halfedges()); ++i) ++leaving[from_vertex(mesh, HalfedgeHandle(i))];
  for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
    progress.step(v, mesh.n_vertices(), 0.7, 1.0);
    const HalfedgeHandle start = mesh.halfedge_handle(VertexHandle(v));
    if (!start.is_valid()) continue;
    int met = 0;
    HalfedgeHandle h = start;
    do {
      ++met;
      h = next(mesh, opposite(h));
    } while (h != start && met <= leaving[v]);
    if (met != leaving[v])
      throw InvalidMesh("vertex " + to_string(v) + " is non-manifold: two fans of faces touch there");
  }
}

}  // namespace

HalfEdges half_edges(const Surface& surface, Progress& progress) {
  HalfEdges mesh;
  mesh.reserve(surface.vertex_count, surface.edges.size(), surface.triangles.size());
  for (int v = 0; v < surface.vertex_count; ++v) mesh.new_vertex();
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    progress.step(e, surface.edges.size(), 0.0, 0.3);
    mesh.new_edge(VertexHandle(surface.edges[e][0]), VertexHandle(surface.edges[e][1]));
  }
  link_triangles(mesh, surface, progress);
  link_boundary(mesh);
  check_vertices(mesh, progress);
  return mesh;
}

void flip_links(HalfEdges& mesh, EdgeHandle e) {
  const HalfedgeHandle a0 = mesh.halfedge_handle(e, 0), b0 = mesh.halfedge_handle(e, 1);
  const HalfedgeHandle a1 = next(mesh, a0), a2 = next(mesh, a1), b1 = next(mesh, b0), b2 = next(mesh, b1);
  const VertexHandle head = mesh.to_vertex_handle(a0), tail = mesh.to_vertex_handle(b0);
  const VertexHandle a_apex = mesh.to_vertex_handle(a1), b_apex = mesh.to_vertex_handle(b1);
  const FaceHandle fa = mesh.face_handle(a0), fb = mesh.face_handle(b0);
  if (mesh.halfedge_handle(head) == b0) mesh.set_halfedge_handle(head, a1);
  if (mesh.halfedge_handle(tail) == a0) mesh.set_halfedge_handle(tail, b1);
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
