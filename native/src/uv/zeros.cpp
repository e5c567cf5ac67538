#include "uv/zeros.h"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace holomorph::uv {
namespace {

class Clusters {
 public:
  explicit Clusters(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }

 private:
  std::vector<int> parent_;
};

constexpr int kNone = -1;

// #V the pole, of `poles`, in whose star each vertex lies, or kNone.
std::vector<int> stars(const mesh::Surface& surface, const std::vector<int>& poles) {
  std::vector<int> own(surface.vertex_count, kNone), star(surface.vertex_count, kNone);
  for (int i = 0; i < static_cast<int>(poles.size()); ++i) own[poles[i]] = i;
  for (const auto& triangle : surface.triangles) {
    for (const int pole : triangle) {
      if (own[pole] == kNone) continue;
      for (const int v : triangle) star[v] = own[pole];
    }
  }
  return star;
}

struct Image {
  std::vector<double> angle;  // of each vertex, the sum of its signed angles outside of the poles' stars
  std::vector<int> flipped;   // triangles there
};

Image image(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, const std::vector<char>& is_pole) {
  Image result{std::vector<double>(surface.vertex_count, 0.0), {}};
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& corner = surface.triangle_corners[t];
    const auto& [x, y, z] = surface.triangles[t];
    if (is_pole[x] || is_pole[y] || is_pole[z]) continue;
    for (int i = 0; i < 3; ++i) {
      const Eigen::RowVector2d here = uv.row(corner[i]), a = uv.row(corner[(i + 1) % 3]) - here,
                               b = uv.row(corner[(i + 2) % 3]) - here;
      const double cross = a[0] * b[1] - a[1] * b[0];
      result.angle[surface.triangles[t][i]] += std::atan2(cross, a.dot(b));
      if (i == 0 && cross < 0) result.flipped.push_back(t);
    }
  }
  return result;
}

// Of the stars of poles, whose triangles have no common image: the image of a link turns once more for each zero
// inside. All of them count for its vertex with the largest angle.
void count_in_stars(const std::vector<int>& star, const std::vector<char>& is_pole, const std::vector<double>& angle,
                    std::vector<int>& index) {
  std::map<int, std::pair<double, int>> found;  // of a star: the turn of its link, and that vertex
  for (int v = 0; v < static_cast<int>(star.size()); ++v) {
    if (star[v] == kNone) continue;
    index[v] = 0;
    if (is_pole[v]) continue;
    auto& [turn, largest] = found.try_emplace(star[v], 0.0, v).first->second;
    turn += angle[v] - std::numbers::pi;
    if (angle[v] > angle[largest]) largest = v;
  }
  for (const auto& [pole, link] : found)
    index[link.second] = static_cast<int>(std::lround(link.first / (2 * std::numbers::pi)));
}

// 0 at vertices without a triangle.
std::vector<int> indices(const mesh::Surface& surface, const std::vector<double>& angle) {
  std::vector<double> flat(surface.vertex_count, 2 * std::numbers::pi);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) flat[surface.edges[e][0]] = flat[surface.edges[e][1]] = std::numbers::pi;
  }
  std::vector<int> index(surface.vertex_count, 0);
  for (const auto& triangle : surface.triangles) {
    for (const int v : triangle) index[v] = static_cast<int>(std::lround(angle[v] / flat[v])) - 1;
  }
  return index;
}

Clusters touching(const mesh::Surface& surface, const std::vector<int>& index, const std::vector<int>& flipped) {
  Clusters clusters(surface.vertex_count);
  for (const int t : flipped) {
    for (const int v : surface.triangles[t]) clusters.join(v, surface.triangles[t][0]);
  }
  for (const auto& [a, b] : surface.edges) {
    if (index[a] != 0 && index[b] != 0) clusters.join(a, b);
  }
  return clusters;
}

}  // namespace

std::vector<Zero> zeros(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv,
                        const std::vector<int>& poles) {
  std::vector<char> is_pole(surface.vertex_count, 0);
  for (const int pole : poles) is_pole[pole] = 1;
  const auto [angle, flipped] = image(surface, uv, is_pole);
  std::vector<int> index = indices(surface, angle);
  count_in_stars(stars(surface, poles), is_pole, angle, index);
  Clusters clusters = touching(surface, index, flipped);
  std::map<int, Zero> found;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (index[v] == 0) continue;
    Zero& zero = found.try_emplace(clusters.root(v), Zero{v, 0}).first->second;
    if (index[v] > index[zero.vertex]) zero.vertex = v;
    zero.order += index[v];
  }
  for (const int t : flipped) {
    const int v = surface.triangles[t][0];
    ++found.try_emplace(clusters.root(v), Zero{v, 0}).first->second.order;
  }
  std::vector<Zero> result;
  for (const auto& [root, zero] : found) {
    if (zero.order != 0) result.push_back(zero);
  }
  return result;
}

}  // namespace holomorph::uv
