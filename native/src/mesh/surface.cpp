#include "mesh/surface.h"

#include <algorithm>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {

double area(const Surface& surface, Workers& workers) {
  return sum_over_rows(workers, static_cast<int>(surface.triangles.size()), 0.0, [&surface](int t, double& sum) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const auto& l = surface.edge_lengths;
    sum += triangle_area(l[a], l[b], l[c]);
  });
}

std::vector<double> vertex_areas(const Surface& surface, std::span<const double> lengths) {
  std::vector<double> areas(surface.vertex_count, 0.0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const double area = triangle_area(lengths[a], lengths[b], lengths[c]);
    for (const int v : surface.triangles[t]) areas[v] += area / 3;
  }
  return areas;
}

int edge_between(std::span<const Pair> edges, int a, int b) {
  const Pair ends{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(edges.begin(), edges.end(), ends);
  return found != edges.end() && *found == ends ? static_cast<int>(found - edges.begin()) : -1;
}

}  // namespace holomorph::mesh
