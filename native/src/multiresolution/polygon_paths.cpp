#include "multiresolution/polygon_paths.h"

#include <algorithm>
#include <map>
#include <span>

namespace holomorph::multiresolution {
namespace {

using mesh::HalfedgeHandle;
using mesh::Pair;
using mesh::Surface;

// Number of each edge whose ends are both wanted, by its ends. @pre no two of them have the same ends
class EdgeIndex {
 public:
  EdgeIndex(const Surface& surface, const std::vector<char>& wanted) {
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
      const auto& [a, b] = surface.edges[e];
      if (wanted[a] != 0 && wanted[b] != 0) index_[{a, b}] = static_cast<int>(e);
    }
  }
  int operator()(int a, int b) const { return index_.at({std::min(a, b), std::max(a, b)}); }
  HalfedgeHandle half_edge(int a, int b) const { return HalfedgeHandle(2 * (*this)(a, b) + (a > b)); }

 private:
  std::map<Pair, int> index_;
};

// Polygons in which a diagonal was flipped.
struct FlippedPolygons {
  std::vector<int> polygon;  // #E polygon of each flipped diagonal, -1 for all other edges
  std::vector<char> corner;  // #V 1 for the corners of these polygons
};

FlippedPolygons flipped_polygons(const Surface& surface, const Surface& flipped) {
  FlippedPolygons result{std::vector<int>(surface.edges.size(), -1),
                         std::vector<char>(static_cast<std::size_t>(surface.vertex_count), 0)};
  const auto& [vertices, corners, offsets] = surface.polygons;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) {
      if (surface.edges[e] == flipped.edges[e]) continue;
      const int face = result.polygon[e] = surface.triangle_faces[t];
      for (auto c = offsets[face]; c < offsets[face + 1]; ++c) result.corner[corners[c]] = 1;
    }
  }
  return result;
}

// Vertices of a polygon from a to b, both included.
std::vector<int> path_along(const Surface& surface, int face, int a, int b) {
  const auto& [vertices, corners, offsets] = surface.polygons;
  const auto begin = corners.begin() + offsets[face], end = corners.begin() + offsets[face + 1];
  std::vector<int> path;
  for (auto c = std::find(begin, end, a); path.empty() || path.back() != b; c = c + 1 == end ? begin : c + 1) {
    path.push_back(static_cast<int>(*c));
  }
  return path;
}

}  // namespace

void values_of_diagonals(const Surface& surface, const Surface& flipped, topology::IntegerForms& forms) {
  const FlippedPolygons change = flipped_polygons(surface, flipped);
  // Edges of polygons come first, in lexicographic order.
  const auto polygon_edges = std::span(surface.edges).first(static_cast<std::size_t>(surface.polygon_edge_count));
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (change.polygon[e] < 0) continue;
    const auto path = path_along(surface, change.polygon[e], surface.edges[e][0], surface.edges[e][1]);
    topology::IntegerForms::Row sum;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      sum = topology::add(sum, forms.rows[mesh::edge_between(polygon_edges, path[i], path[i + 1])],
                          path[i] < path[i + 1] ? 1 : -1);
    }
    forms.rows.set(e, std::move(sum));
  }
}

std::vector<std::vector<HalfedgeHandle>> loops_of_half_edges(const Surface& surface, const Surface& flipped,
                                                             const std::vector<std::vector<int>>& loops) {
  const FlippedPolygons change = flipped_polygons(surface, flipped);
  std::vector<char> wanted = change.corner;
  for (const auto& loop : loops) {
    for (const int v : loop) wanted[v] = 1;
  }
  const EdgeIndex edge(flipped, wanted);
  std::vector<std::vector<HalfedgeHandle>> result;
  for (const auto& loop : loops) {
    result.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()], face = change.polygon[edge(a, b)];
      const std::vector<int> path = face < 0 ? std::vector<int>{a, b} : path_along(surface, face, a, b);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) result.back().push_back(edge.half_edge(path[k], path[k + 1]));
    }
  }
  return result;
}

}  // namespace holomorph::multiresolution
