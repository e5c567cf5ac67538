#include "multiresolution/polygon_paths.h"

#include <algorithm>
#include <map>

namespace holomorph::multiresolution {
namespace {

using mesh::HalfedgeHandle;
using mesh::Pair;
using mesh::Surface;

Pair ends_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Edges of a surface by their ends, those only whose ends are both wanted. @pre no two of them have the same ends
class EdgeIndex {
 public:
  EdgeIndex(const Surface& surface, const std::vector<char>& wanted, int edge_count) {
    for (int e = 0; e < edge_count; ++e) {
      const auto& [a, b] = surface.edges[e];
      if (wanted[a] != 0 && wanted[b] != 0) index_[{a, b}] = e;
    }
  }
  int operator()(int a, int b) const { return index_.at(ends_of(a, b)); }
  HalfedgeHandle half_edge(int a, int b) const { return HalfedgeHandle(2 * (*this)(a, b) + (a > b)); }

 private:
  std::map<Pair, int> index_;
};

// The polygons' edges of all corners of the polygons in which a diagonal was turned.
struct Turned {
  std::vector<int> polygon;  // #E of the turned diagonals, -1 for all other edges
  std::vector<char> corner;  // #V 1 for the corners of these polygons
};

Turned find_turned(const Surface& surface, const Surface& turned) {
  Turned result{std::vector<int>(surface.edges.size(), -1),
                std::vector<char>(static_cast<std::size_t>(surface.vertex_count), 0)};
  const auto& [vertices, corners, offsets] = surface.polygons;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) {
      if (surface.edges[e] == turned.edges[e]) continue;
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

void values_of_diagonals(const Surface& surface, const Surface& turned, topology::IntegerForms& forms) {
  const Turned change = find_turned(surface, turned);
  const EdgeIndex edge(surface, change.corner, surface.polygon_edge_count);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (change.polygon[e] < 0) continue;
    const auto path = path_along(surface, change.polygon[e], surface.edges[e][0], surface.edges[e][1]);
    topology::IntegerForms::Row sum;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      sum = topology::add(sum, forms.rows[edge(path[i], path[i + 1])], path[i] < path[i + 1] ? 1 : -1);
    }
    forms.rows.set(e, std::move(sum));
  }
}

std::vector<std::vector<HalfedgeHandle>> loops_of_half_edges(const Surface& surface, const Surface& turned,
                                                             const std::vector<std::vector<int>>& loops) {
  const Turned change = find_turned(surface, turned);
  std::vector<char> wanted = change.corner;
  for (const auto& loop : loops) {
    for (const int v : loop) wanted[v] = 1;
  }
  const EdgeIndex edge(turned, wanted, static_cast<int>(turned.edges.size()));
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
