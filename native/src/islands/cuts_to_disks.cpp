#include "islands/cuts_to_disks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/border_paths.h"
#include "mesh/edge_faces.h"
#include "mesh/union_find.h"

namespace holomorph::islands {
namespace {

// Marks the edge and the paths from its ends.
void mark(const mesh::Surface& surface, const mesh::BorderPaths& paths, int edge, std::vector<char>& is_cut) {
  is_cut[edge] = 1;
  for (const int v : surface.edges[edge]) paths.mark(surface, v, is_cut);
}

}  // namespace

std::vector<char> cuts_to_disks(const mesh::Surface& surface, Execution& execution) {
  const mesh::BorderPaths forest = mesh::border_paths(surface, mesh::on_border(surface, {}), {}, execution);
  const auto faces = mesh::edge_faces(surface);
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
