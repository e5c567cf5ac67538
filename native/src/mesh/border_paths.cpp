#include "mesh/border_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/half_edges.h"
#include "mesh/surface_walk.h"

namespace holomorph::mesh {
namespace {

// Part of the longest edge: edges are no shorter, so that a path goes on where two vertices are at one place.
constexpr double kShortest = 1e-12;

}  // namespace

std::vector<char> on_border(const Surface& surface, const std::vector<char>& is_cut) {
  std::vector<char> result(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1 || (!is_cut.empty() && is_cut[e]))
      result[surface.edges[e][0]] = result[surface.edges[e][1]] = 1;
  }
  return result;
}

void BorderPaths::mark(const Surface& surface, int vertex, std::vector<char>& is_marked) const {
  for (int step = edge_to_border[vertex]; step >= 0 && !is_marked[step]; step = edge_to_border[vertex]) {
    is_marked[step] = 1;
    vertex = surface.edges[step][0] == vertex ? surface.edges[step][1] : surface.edges[step][0];
  }
}

BorderPaths border_paths(const Surface& surface, const std::vector<char>& is_border, const std::vector<double>& times,
                         Execution& execution) {
  std::vector<double> lengths(surface.edge_lengths.begin(), surface.edge_lengths.end());
  for (std::size_t e = 0; e < times.size(); ++e) lengths[e] *= times[e];
  const double shortest = kShortest * *std::max_element(lengths.begin(), lengths.end());
  for (double& length : lengths) length = std::max(length, shortest);
  // Infinite lengths keep paths off the diagonals.
  std::fill(lengths.begin() + surface.polygon_edge_count, lengths.end(), std::numeric_limits<double>::infinity());
  std::vector<int> sources;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (is_border[v]) sources.push_back(v);
  }
  BorderPaths paths{graph_distances(half_edges(surface, execution), lengths, sources),
                    std::vector<int>(surface.vertex_count, -1)};
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    for (int i = 0; i < 2; ++i) {
      const int from = surface.edges[e][i];
      const double here = paths.distances[from], there = paths.distances[surface.edges[e][1 - i]];
      // The first edge of a shortest path. Distances are sums of these same numbers, so that the equality is exact.
      if (paths.edge_to_border[from] < 0 && std::isfinite(here) && there < here && there + lengths[e] == here)
        paths.edge_to_border[from] = e;
    }
  }
  return paths;
}

std::vector<char> paths_to_border(const Surface& surface, const std::vector<char>& is_border,
                                  const std::vector<char>& starts, Execution& execution) {
  std::vector<char> result(surface.edges.size(), 0);
  const auto any = [](const std::vector<char>& flags) { return std::ranges::find(flags, 1) != flags.end(); };
  if (!any(is_border) || !any(starts)) return result;
  const BorderPaths paths = border_paths(surface, is_border, {}, execution);
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (starts[v]) paths.mark(surface, v, result);
  }
  return result;
}

}  // namespace holomorph::mesh
