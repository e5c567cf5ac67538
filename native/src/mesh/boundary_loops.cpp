#include "mesh/boundary_loops.h"

#include <algorithm>

namespace holomorph::mesh {
namespace {

// A loop is longer than another one only by more than this fraction: sums of the same lengths differ by rounding.
constexpr double kLonger = 1e-9;

}  // namespace

BoundaryLoops boundary_loops(const Surface& surface, const HalfEdges& half_edges) {
  BoundaryLoops result;
  result.loop_of_vertex.assign(half_edges.n_vertices(), -1);
  double longest = 0;
  std::size_t first = 0;
  for (int v = 0; v < static_cast<int>(half_edges.n_vertices()); ++v) {
    const HalfedgeHandle start =
        half_edges.halfedge_handle(VertexHandle(v));  // at the boundary, the one without a face
    if (!start.is_valid() || half_edges.face_handle(start).is_valid() || result.loop_of_vertex[v] >= 0) continue;
    std::vector<HalfedgeHandle> loop;
    double length = 0;
    HalfedgeHandle h = start;
    do {
      loop.push_back(h);
      length += surface.edge_lengths[edge_of(h)];
      result.loop_of_vertex[from_vertex(half_edges, h)] = 0;
      h = next(half_edges, h);
    } while (h != start);
    if (length > (1 + kLonger) * longest) longest = length, first = result.loops.size();
    result.loops.push_back(std::move(loop));
  }
  if (first > 0)
    std::rotate(result.loops.begin(), result.loops.begin() + static_cast<std::ptrdiff_t>(first),
                result.loops.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  for (int k = 0; k < result.count(); ++k) {
    for (const HalfedgeHandle h : result.loops[k]) result.loop_of_vertex[from_vertex(half_edges, h)] = k;
  }
  return result;
}

BoundaryLoops renumbered(const BoundaryLoops& boundary, const std::vector<int>& number) {
  BoundaryLoops result;
  result.loops.resize(boundary.loops.size());
  for (int k = 0; k < boundary.count(); ++k) result.loops[number[k]] = boundary.loops[k];
  result.loop_of_vertex = boundary.loop_of_vertex;
  for (int& loop : result.loop_of_vertex) loop = loop < 0 ? -1 : number[loop];
  return result;
}

std::vector<int> boundary_vertices(const HalfEdges& half_edges) {
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(half_edges.n_vertices()); ++v) {
    if (half_edges.is_boundary(VertexHandle(v))) vertices.push_back(v);
  }
  return vertices;
}

std::vector<int> boundary_vertices(const BoundaryLoops& boundary) {
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(boundary.loop_of_vertex.size()); ++v) {
    if (boundary.loop_of_vertex[v] >= 0) vertices.push_back(v);
  }
  return vertices;
}

std::vector<int> triangles_on_one_loop(const Surface& surface, const BoundaryLoops& boundary) {
  std::vector<int> triangles;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const auto& loop = boundary.loop_of_vertex;
    if (loop[a] >= 0 && loop[a] == loop[b] && loop[a] == loop[c]) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace holomorph::mesh
