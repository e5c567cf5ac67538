#include "mesh/self_intersections.h"

#include <algorithm>
#include <cmath>

#include "base/chunks.h"
#include "mesh/triangle_tree.h"

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;

// Rounding of a determinant, relative to the sum of its terms' sizes: some ten units.
constexpr double kRounding = 1e-14;

// The side of the plane (a, b, c) on which d lies; 0 where rounding decides.
int side_of_plane(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d x = a - d, y = b - d, z = c - d;
  const double determinant = x.dot(y.cross(z));
  const Vector3d u = y.cwiseAbs(), v = z.cwiseAbs();
  const double size = std::abs(x[0]) * (u[1] * v[2] + u[2] * v[1]) + std::abs(x[1]) * (u[2] * v[0] + u[0] * v[2]) +
                      std::abs(x[2]) * (u[0] * v[1] + u[1] * v[0]);
  return std::abs(determinant) <= kRounding * size ? 0 : determinant > 0 ? 1 : -1;
}

class Looking {
 public:
  Looking(const std::vector<std::array<double, 3>>& vertices, const std::vector<Triple>& triangles)
      : vertices_(vertices), triangles_(triangles), tree_(vertices, triangles) {}

  // Those of triangle t and ones with higher numbers.
  void look(int t, std::vector<int>& near, std::vector<Pair>& found) const {
    near.clear();
    const Eigen::AlignedBox3d box = box_of(t);
    tree_.find_near(box, near);
    std::sort(near.begin(), near.end());
    for (const int s : near) {
      if (s > t && box.intersects(box_of(s)) && cross(t, s)) found.push_back({t, s});
    }
  }

 private:
  Vector3d at(int v) const { return Vector3d(vertices_[v].data()); }

  Eigen::AlignedBox3d box_of(int t) const {
    Eigen::AlignedBox3d box;
    for (const int v : triangles_[t]) box.extend(at(v));
    return box;
  }

  static bool has(const Triple& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

  bool cross(int s, int t) const {
    const Triple &a = triangles_[s], &b = triangles_[t];
    // Triangles with a common edge meet there only, or are folded onto each other.
    if (has(a, b[0]) + has(a, b[1]) + has(a, b[2]) > 1) return false;
    return goes_through(a, b) || goes_through(b, a);
  }

  bool goes_through(const Triple& from, const Triple& t) const {
    for (int i = 0; i < 3; ++i) {
      const int p = from[i], q = from[(i + 1) % 3];
      if (!has(t, p) && !has(t, q) && side_goes_through(at(p), at(q), t)) return true;
    }
    return false;
  }

  bool side_goes_through(const Vector3d& p, const Vector3d& q, const Triple& t) const {
    const Vector3d a = at(t[0]), b = at(t[1]), c = at(t[2]);
    if (side_of_plane(a, b, c, p) * side_of_plane(a, b, c, q) >= 0) return false;
    // The line meets the triangle if it passes all three sides on the same hand.
    const int first = side_of_plane(p, q, a, b);
    return first != 0 && first == side_of_plane(p, q, b, c) && first == side_of_plane(p, q, c, a);
  }

  const std::vector<std::array<double, 3>>& vertices_;
  const std::vector<Triple>& triangles_;
  TriangleTree tree_;
};

}  // namespace

std::vector<Pair> self_intersections(const std::vector<std::array<double, 3>>& vertices,
                                     const std::vector<Triple>& triangles, Execution& execution) {
  if (triangles.empty()) return {};
  const Looking looking(vertices, triangles);
  const int count = static_cast<int>(triangles.size()), chunks = chunk_count(count);
  std::vector<std::vector<Pair>> parts(chunks);
  run_throwing(execution.workers(), chunks, [&](int chunk) {
    std::vector<int> near;
    for (int t = chunk * kChunk, end = std::min(t + kChunk, count); t < end; ++t) looking.look(t, near, parts[chunk]);
  });
  std::vector<Pair> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace holomorph::mesh
