#include "tiling/inversion/neighbourhoods.h"

#include <set>

namespace holomorph::tiling {

std::vector<int> vertices_around(const mesh::HalfEdges& half_edges, int vertex, std::size_t most) {
  std::vector<int> queue{vertex};
  std::set<int> seen{vertex};
  for (std::size_t next = 0; next < queue.size() && queue.size() < most; ++next) {
    const mesh::HalfedgeHandle first = half_edges.halfedge_handle(mesh::VertexHandle(queue[next]));
    mesh::HalfedgeHandle h = first;
    do {
      const int v = mesh::to_vertex(half_edges, h);
      if (seen.insert(v).second) queue.push_back(v);
      h = mesh::next(half_edges, mesh::opposite(h));
    } while (h != first);
  }
  return queue;
}

bool are_apart(const std::vector<int>& a, const std::vector<int>& b) {
  for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end();) {
    if (*x == *y) return false;
    ++(*x < *y ? x : y);
  }
  return true;
}

}  // namespace holomorph::tiling
