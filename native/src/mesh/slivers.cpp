#include "mesh/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

}  // namespace holomorph::mesh
