#include "mesh/cut_open.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "mesh/half_edges.h"
#include "mesh/make_surface.h"
#include "mesh/stars.h"
#include "mesh/triangle_geometry.h"
#include "mesh/union_find.h"

namespace holomorph::mesh {
namespace {

// Part of the longest side: no shape that is meant is thinner.
constexpr double kLow = 1e-4;
// Part of the coordinates of the middle one of three points: their rounding to single precision, or to six decimals.
constexpr double kCoordinateRounding = 0x1p-20;

bool is_sliver(const Surface& surface, int triangle) {
  const auto& [i, j, k] = surface.triangle_edges[triangle];
  const double a = surface.edge_lengths[i], b = surface.edge_lengths[j], c = surface.edge_lengths[k];
  if (is_degenerate(a, b, c)) return true;
  const double longest = std::max({a, b, c}), height = 2 * triangle_area(a, b, c) / longest;
  if (surface.intrinsic() || height > kLow * longest) return false;
  std::array<double, 3> sizes{};
  for (int c = 0; c < 3; ++c) {
    for (const double x : surface.polygons.vertices[surface.triangles[triangle][c]])
      sizes[c] = std::max(sizes[c], std::abs(x));
  }
  std::sort(sizes.begin(), sizes.end());  // a spike has one far point
  return height <= kCoordinateRounding * sizes[1];
}

bool has_any(const std::vector<char>& flags) { return std::find(flags.begin(), flags.end(), 1) != flags.end(); }

// Parts of a surface that is cut, each known by its lowest polygon, and in each a polygon that is no sliver.
class Parts {
 public:
  explicit Parts(const std::vector<char>& is_sliver) : sets_(is_sliver.size()), owner_(is_sliver.size()) {
    for (std::size_t f = 0; f < is_sliver.size(); ++f) owner_[f] = is_sliver[f] ? -1 : static_cast<int>(f);
  }

  int owner(int face) { return owner_[sets_.lowest(face)]; }

  void join(int a, int b) {
    const int one = owner(a), other = owner(b);
    sets_.join(a, b);
    owner_[sets_.lowest(a)] = one >= 0 ? one : other;
  }

  bool are_apart(int a, int b) { return sets_.lowest(a) != sets_.lowest(b); }

 private:
  UnionFind sets_;
  std::vector<int> owner_;  // of the lowest polygon of each part, -1 where there are slivers alone
};

// Joins parts of slivers to others across edges that are cut, which then are not.
void join_slivers(const Surface& surface, const std::vector<Pair>& faces, Parts& parts, std::vector<char>& is_cut) {
  std::vector<int> order;
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    if (is_cut[e] && faces[e][1] >= 0) order.push_back(e);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return surface.edge_lengths[a] > surface.edge_lengths[b]; });
  for (const int e : order) {
    const auto [a, b] = faces[e];
    if (!parts.are_apart(a, b) || (parts.owner(a) >= 0 && parts.owner(b) >= 0)) continue;
    parts.join(a, b);
    is_cut[e] = 0;
  }
}

// Part of the longest edge: edges are no shorter, so that a path goes on where two vertices are at one place.
constexpr double kShortest = 1e-12;

int next_side(int side) { return side % 3 == 2 ? side - 2 : side + 1; }

// Names the fan of each triangle corner, 3 #T. The corner at the start of a side is followed by that of the triangle
// across it: a fan is a path of corners, named by its end, or a cycle, named by its lowest.
std::vector<int> fans(const Surface& surface, const std::vector<char>& is_cut) {
  const int count = 3 * static_cast<int>(surface.triangles.size());
  std::vector<int> following(count), before(count, -1), names(count, -1);
  std::iota(following.begin(), following.end(), 0);
  const std::vector<Pair> sides = edge_sides(surface);
  for (std::size_t e = 0; e < sides.size(); ++e) {
    const auto [one, other] = sides[e];
    if (other < 0 || is_cut[e]) continue;
    following[one] = next_side(other);
    following[other] = next_side(one);
  }
  for (int c = 0; c < count; ++c) {
    if (following[c] != c) before[following[c]] = c;
  }
  for (int c = 0; c < count; ++c) {
    if (following[c] != c) continue;
    for (int at = c; at >= 0 && names[at] < 0; at = before[at]) names[at] = c;
  }
  for (int c = 0; c < count; ++c) {
    for (int at = c; names[at] < 0; at = following[at]) names[at] = c;
  }
  return names;
}

}  // namespace

std::vector<char> slivers(const Surface& surface) {
  std::vector<char> result(surface.polygons.face_offsets.size() - 1, 1);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    if (!is_sliver(surface, t)) result[surface.triangle_faces[t]] = 0;
  }
  return result;
}

std::vector<char> cut_without_sliver_parts(const Surface& surface, std::vector<char> is_cut) {
  const std::vector<char> flat = slivers(surface);
  if (!has_any(flat)) return is_cut;
  const std::vector<Pair> faces = edge_faces(surface);
  Parts parts(flat);
  for (int e = 0; e < surface.polygon_edge_count; ++e) {
    if (!is_cut[e] && faces[e][1] >= 0) parts.join(faces[e][0], faces[e][1]);
  }
  join_slivers(surface, faces, parts, is_cut);
  return is_cut;
}

std::vector<int> sliver_owners(const Surface& surface) {
  const std::vector<char> flat = slivers(surface);
  std::vector<int> owners(flat.size());
  std::iota(owners.begin(), owners.end(), 0);
  if (!has_any(flat)) return owners;
  Parts parts(flat);
  std::vector<char> is_cut(surface.edges.size(), 1);
  join_slivers(surface, edge_faces(surface), parts, is_cut);
  for (int f = 0; f < static_cast<int>(owners.size()); ++f) owners[f] = parts.owner(f) < 0 ? f : parts.owner(f);
  return owners;
}

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
  std::fill(lengths.begin() + surface.polygon_edge_count, lengths.end(), kInfinity);
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

PartedVertices parted_vertices(const Surface& surface, const std::vector<char>& is_cut) {
  const std::vector<int> names = fans(surface, is_cut);
  const auto vertex_of = [&](int corner) { return surface.triangles[corner / 3][corner % 3]; };
  // One corner of each fan has its name: sorted by vertices, they number the copies.
  std::vector<int> first(surface.vertex_count + 1, 0);
  for (int c = 0; c < std::ssize(names); ++c) {
    if (names[c] == c) ++first[vertex_of(c) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  PartedVertices result{std::vector<int>(first.back()), std::vector<Triple>(surface.triangles.size())};
  std::vector<int> copy(names.size(), -1);
  for (int c = 0; c < std::ssize(names); ++c) {
    if (names[c] != c) continue;
    copy[c] = first[vertex_of(c)]++;
    result.vertices[copy[c]] = vertex_of(c);
  }
  for (int c = 0; c < std::ssize(names); ++c) result.of_triangles[c / 3][c % 3] = copy[names[c]];
  return result;
}

OpenSurface cut_open(const Surface& surface, const std::vector<char>& is_cut, Execution& execution) {
  PartedVertices parted = parted_vertices(surface, cut_without_sliver_parts(surface, is_cut));
  Polygons polygons{{}, std::vector<int>(surface.polygons.corner_vertices.size()), surface.polygons.face_offsets};
  for (const int v : parted.vertices) polygons.vertices.push_back(surface.polygons.vertices[v]);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) polygons.corner_vertices[surface.triangle_corners[t][i]] = parted.of_triangles[t][i];
  }
  return {make_surface(std::move(polygons), execution), std::move(parted.vertices)};
}

std::vector<int> parts(const Surface& surface, const std::vector<char>& is_cut) {
  const std::vector<char> left = cut_without_sliver_parts(surface, is_cut);
  const int count = static_cast<int>(surface.face_component.size());
  UnionFind sets(count);
  const std::vector<Pair> faces = edge_faces(surface);
  for (std::size_t e = 0; e < faces.size(); ++e) {
    if (faces[e][1] >= 0 && !left[e]) sets.join(faces[e][0], faces[e][1]);
  }
  std::vector<int> result(count);
  int parts = 0;
  for (int f = 0; f < count; ++f) result[f] = sets.lowest(f) == f ? parts++ : result[sets.lowest(f)];
  return result;
}

std::vector<char> edges_between(const Surface& surface, const std::vector<int>& names) {
  std::vector<char> result(surface.edges.size(), 0);
  const std::vector<Pair> faces = edge_faces(surface);
  for (std::size_t e = 0; e < faces.size(); ++e)
    result[e] = faces[e][1] >= 0 && names[faces[e][0]] != names[faces[e][1]] ? 1 : 0;
  return result;
}

OrientedSurface in_one_orientation(const Surface& surface, Execution& execution) {
  if (surface.repairs.reversed_faces.empty()) return {surface, {}};
  std::vector<int> order(surface.polygons.corner_vertices.size());
  std::iota(order.begin(), order.end(), 0);
  Polygons polygons = surface.polygons;
  for (const int f : surface.repairs.reversed_faces) {
    const int begin = polygons.face_offsets[f], end = polygons.face_offsets[f + 1];
    std::reverse(order.begin() + begin, order.begin() + end);
    std::reverse(polygons.corner_vertices.begin() + begin, polygons.corner_vertices.begin() + end);
  }
  return {make_surface(std::move(polygons), execution), std::move(order)};
}

}  // namespace holomorph::mesh
