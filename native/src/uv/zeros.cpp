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

struct Image {
  std::vector<double> angle;  // of each vertex, the sum of its signed angles
  std::vector<int> flipped;   // triangles
};

Image image(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv) {
  Image result{std::vector<double>(surface.vertex_count, 0.0), {}};
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& corner = surface.triangle_corners[t];
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

// 0 at vertices without a triangle.
std::vector<int> indices(const mesh::Surface& surface, const std::vector<double>& angle,
                         const std::vector<int>& left_out) {
  std::vector<double> flat(surface.vertex_count, 2 * std::numbers::pi);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) flat[surface.edges[e][0]] = flat[surface.edges[e][1]] = std::numbers::pi;
  }
  std::vector<int> index(surface.vertex_count, 0);
  for (const auto& triangle : surface.triangles) {
    for (const int v : triangle) index[v] = static_cast<int>(std::lround(angle[v] / flat[v])) - 1;
  }
  for (const int v : left_out) index[v] = 0;
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
                        const std::vector<int>& left_out) {
  const auto [angle, flipped] = image(surface, uv);
  const std::vector<int> index = indices(surface, angle, left_out);
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
