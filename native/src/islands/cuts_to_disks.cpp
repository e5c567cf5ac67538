#include "islands/cuts_to_disks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/half_edges.h"
#include "mesh/surface_walk.h"
#include "mesh/union_find.h"

namespace holomorph::islands {
namespace {

// Part of the longest edge: edges are no shorter, so that a path goes on where two vertices are at one place.
constexpr double kShortest = 1e-12;

// The paths to the boundary along the edges of polygons.
struct Forest {
  std::vector<double> distances;    // #V; infinite where no path leads to a boundary
  std::vector<int> edge_to_border;  // #V the first edge of the path, -1 at its end
};

Forest paths_to_border(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  std::vector<double> lengths(surface.edge_lengths.begin(), surface.edge_lengths.end());
  const double shortest = kShortest * *std::max_element(lengths.begin(), lengths.end());
  for (double& length : lengths) length = std::max(length, shortest);
  // Infinite lengths keep paths off the diagonals.
  std::fill(lengths.begin() + surface.polygon_edge_count, lengths.end(), std::numeric_limits<double>::infinity());
  std::vector<char> is_border(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) is_border[surface.edges[e][0]] = is_border[surface.edges[e][1]] = 1;
  }
  std::vector<int> sources;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (is_border[v]) sources.push_back(v);
  }
  Forest forest{mesh::graph_distances(half_edges, lengths, sources), std::vector<int>(surface.vertex_count, -1)};
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    for (int i = 0; i < 2; ++i) {
      const int from = surface.edges[e][i], to = surface.edges[e][1 - i];
      const double here = forest.distances[from], there = forest.distances[to];
      // The first edge of a shortest path. Distances are sums of these same numbers, so that the equality is exact.
      if (!is_border[from] && forest.edge_to_border[from] < 0 && std::isfinite(here) && there < here &&
          there + lengths[e] == here)
        forest.edge_to_border[from] = e;
    }
  }
  return forest;
}

// Both polygons of each polygon's edge, -1 where there is none.
std::vector<mesh::Pair> faces_of_edges(const mesh::Surface& surface) {
  std::vector<mesh::Pair> faces(surface.polygon_edge_count, {-1, -1});
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) {
      if (!surface.is_diagonal(e)) faces[e][faces[e][0] < 0 ? 0 : 1] = surface.triangle_faces[t];
    }
  }
  return faces;
}

// Marks the edge and the paths from its ends.
void mark(const mesh::Surface& surface, const Forest& forest, int edge, std::vector<char>& is_cut) {
  is_cut[edge] = 1;
  for (int v : surface.edges[edge]) {
    for (int step = forest.edge_to_border[v]; step >= 0 && !is_cut[step]; step = forest.edge_to_border[v]) {
      is_cut[step] = 1;
      v = surface.edges[step][0] == v ? surface.edges[step][1] : surface.edges[step][0];
    }
  }
}

}  // namespace

std::vector<char> cuts_to_disks(const mesh::Surface& surface, Execution& execution) {
  const Forest forest = paths_to_border(surface, execution);
  const auto faces = faces_of_edges(surface);
  std::vector<char> is_in_forest(surface.edges.size(), 0), result(surface.edges.size(), 0);
  for (const int e : forest.edge_to_border) {
    if (e >= 0) is_in_forest[e] = 1;
  }
  const auto loop_length = [&](int e) {
    const auto [a, b] = surface.edges[e];
    return forest.distances[a] + forest.distances[b] + surface.edge_lengths[e];
  };
  std::vector<int> crossed;  // edges that the tree of faces may cross
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    if (faces[e][1] >= 0 && !is_in_forest[e] && std::isfinite(loop_length(e))) crossed.push_back(e);
  }
  // Kruskal's algorithm, the longest loops first. An edge that would close a circle of faces is cut, with the paths
  // from its ends to the border: it has one of the shortest loops.
  std::vector<double> length(surface.polygon_edge_count, 0);
  for (const int e : crossed) length[e] = loop_length(e);
  std::stable_sort(crossed.begin(), crossed.end(), [&](int a, int b) { return length[a] > length[b]; });
  mesh::UnionFind tree(surface.polygons.face_offsets.size());
  for (const int e : crossed) {
    if (tree.lowest(faces[e][0]) != tree.lowest(faces[e][1])) {
      tree.join(faces[e][0], faces[e][1]);
    } else {
      mark(surface, forest, e, result);
    }
  }
  return result;
}

}  // namespace holomorph::islands
