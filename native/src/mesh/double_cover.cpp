#include "mesh/double_cover.h"

#include <algorithm>

namespace holomorph::mesh {
namespace {

// Numbers of all elements in the second copy: those of the boundary stay, the others follow `count`.
template <class IsBoundary>
std::vector<int> second_numbers(int count, IsBoundary is_boundary) {
  std::vector<int> numbers(count);
  int following = count;
  for (int i = 0; i < count; ++i) numbers[i] = is_boundary(i) ? i : following++;
  return numbers;
}

}  // namespace

DoubleCover double_cover(const HalfEdges& half_edges, Execution& execution) {
  DoubleCover result;
  const int V = static_cast<int>(half_edges.n_vertices()), E = static_cast<int>(half_edges.n_edges());
  const int F = static_cast<int>(half_edges.n_faces());
  result.dual_vertex = second_numbers(V, [&](int v) { return half_edges.is_boundary(VertexHandle(v)); });
  const auto dual_edge = second_numbers(E, [&](int e) { return half_edges.is_boundary(EdgeHandle(e)); });

  Surface both;  // as much of it as the half-edges are made of
  both.vertex_count = 1 + *std::max_element(result.dual_vertex.begin(), result.dual_vertex.end());
  both.vertex_count = std::max(both.vertex_count, V);
  both.edges.resize(std::max(E, 1 + *std::max_element(dual_edge.begin(), dual_edge.end())));
  const auto add_edge = [&](int edge, int a, int b) { both.edges[edge] = {std::min(a, b), std::max(a, b)}; };
  for (int e = 0; e < E; ++e) {
    const int a = from_vertex(half_edges, HalfedgeHandle(2 * e)), b = to_vertex(half_edges, HalfedgeHandle(2 * e));
    add_edge(e, a, b);
    add_edge(dual_edge[e], result.dual_vertex[a], result.dual_vertex[b]);
  }
  both.triangles.resize(2 * static_cast<std::size_t>(F));
  both.triangle_edges.resize(2 * static_cast<std::size_t>(F));
  for (int f = 0; f < F; ++f) {
    HalfedgeHandle h = half_edges.halfedge_handle(FaceHandle(f));
    for (int i = 0; i < 3; ++i, h = next(half_edges, h)) {
      both.triangles[f][i] = from_vertex(half_edges, h);
      both.triangle_edges[f][i] = edge_of(h);
      // Backwards in the second copy: side 2 - i runs from the end of h to its start.
      both.triangles[F + f][2 - i] = result.dual_vertex[to_vertex(half_edges, h)];
      both.triangle_edges[F + f][2 - i] = dual_edge[edge_of(h)];
    }
  }
  result.half_edges = mesh::half_edges(both, execution);

  result.first.resize(half_edges.n_halfedges());
  result.second.resize(half_edges.n_halfedges());
  for (int f = 0; f < F; ++f) {
    HalfedgeHandle h = half_edges.halfedge_handle(FaceHandle(f)), a = result.half_edges.halfedge_handle(FaceHandle(f));
    HalfedgeHandle side[3];
    for (int i = 0; i < 3; ++i)
      side[i] = i == 0 ? result.half_edges.halfedge_handle(FaceHandle(F + f)) : next(result.half_edges, side[i - 1]);
    for (int i = 0; i < 3; ++i, h = next(half_edges, h), a = next(result.half_edges, a)) {
      result.first[h.idx()] = a;
      result.second[h.idx()] = opposite(side[2 - i]);
    }
  }
  return result;
}

}  // namespace holomorph::mesh
