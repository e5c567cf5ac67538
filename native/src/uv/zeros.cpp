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

}  // namespace

std::vector<Zero> zeros(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv,
                        const std::vector<int>& left_out) {
  const int count = surface.vertex_count;
  std::vector<double> angle(count, 0.0);
  std::vector<char> inner(count, 1), met(count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 1) inner[surface.edges[e][0]] = inner[surface.edges[e][1]] = 0;
  }
  std::vector<std::size_t> flipped;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corner = surface.triangle_corners[t];
    for (int i = 0; i < 3; ++i) {
      const Eigen::RowVector2d here = uv.row(corner[i]), a = uv.row(corner[(i + 1) % 3]) - here,
                               b = uv.row(corner[(i + 2) % 3]) - here;
      const double cross = a[0] * b[1] - a[1] * b[0];
      angle[surface.triangles[t][i]] += std::atan2(cross, a.dot(b));
      met[surface.triangles[t][i]] = 1;
      if (i == 0 && cross < 0) flipped.push_back(t);
    }
  }
  for (const int v : left_out) met[v] = 0;
  std::vector<int> index(count, 0);
  for (int v = 0; v < count; ++v) {
    if (met[v]) index[v] = static_cast<int>(std::lround(angle[v] / (std::numbers::pi * (inner[v] ? 2 : 1)))) - 1;
  }
  Clusters clusters(count);
  for (const std::size_t t : flipped) {
    for (const int v : surface.triangles[t]) clusters.join(v, surface.triangles[t][0]);
  }
  for (const auto& [a, b] : surface.edges) {
    if (index[a] != 0 && index[b] != 0) clusters.join(a, b);
  }
  std::map<int, Zero> found;
  for (int v = 0; v < count; ++v) {
    if (index[v] == 0) continue;
    Zero& zero = found.try_emplace(clusters.root(v), Zero{v, 0}).first->second;
    if (index[v] > index[zero.vertex]) zero.vertex = v;
    zero.order += index[v];
  }
  for (const std::size_t t : flipped) {
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
