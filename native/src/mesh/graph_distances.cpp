#include "mesh/graph_distances.h"

#include <functional>
#include <limits>
#include <queue>

namespace holomorph::mesh {

std::vector<double> graph_distances(const HalfEdges& half_edges, std::span<const double> lengths,
                                    const std::vector<int>& sources) {
  using Entry = std::pair<double, int>;
  std::vector<double> distance(half_edges.n_vertices(), std::numeric_limits<double>::infinity());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int v : sources) {
    distance[v] = 0;
    queue.push({0.0, v});
  }
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > distance[v]) continue;
    const HalfedgeHandle start = half_edges.halfedge_handle(VertexHandle(v));
    if (!start.is_valid()) continue;
    HalfedgeHandle h = start;
    do {
      const int w = to_vertex(half_edges, h);
      const double through = at + lengths[edge_of(h)];
      if (through < distance[w]) queue.push({distance[w] = through, w});
      h = next(half_edges, opposite(h));
    } while (h != start);
  }
  return distance;
}

}  // namespace holomorph::mesh
