#include "mesh/triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::array<int, 3>>;

constexpr int kExactSize = 64;
// Cost of a triangle that is degenerate or inverted: above that of any other.
constexpr double kBadTriangle = 1e12;
// Below this ratio of area to squared size a triangle counts as degenerate.
constexpr double kThin = 1e-10;
// Added for a triangle with all corners on one boundary loop: more than any but a nearly degenerate shape costs.
constexpr double kOnOneLoop = 1e8;
// A difference of costs that rounding of the corners to single precision may make decides nothing: where the corners of
// a polygon lie on one circle, it would be cut otherwise in each copy. Over the largest coordinate in shortest sides.
constexpr double kTie = 32 * 0x1p-24, kMostTie = 1e-2;

class Polygon {
 public:
  Polygon(const std::vector<std::array<double, 3>>& corners, const std::vector<int>& loops) : loops_(loops) {
    // Relative to the first corner, so that a polygon far from the origin loses no digits.
    for (const auto& p : corners)
      points_.push_back(Vector3d(p[0] - corners[0][0], p[1] - corners[0][1], p[2] - corners[0][2]));
    Vector3d area = Vector3d::Zero();
    for (int i = 1; i + 1 < size(); ++i) area += points_[i].cross(points_[i + 1]);
    normal_ = area.normalized();
    double largest = 0, shortest = points_.back().norm();
    for (const auto& p : corners) largest = std::max({largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    for (int i = 1; i < size(); ++i) shortest = std::min(shortest, (points_[i] - points_[i - 1]).norm());
    tie_ = std::min(kMostTie, kTie * largest / shortest);
  }

  int size() const { return static_cast<int>(points_.size()); }
  double tie() const { return tie_; }

  double cost(int i, int j, int k) const {
    const Vector3d a = points_[j] - points_[i], b = points_[k] - points_[i];
    const double squares = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
    const Vector3d cross = a.cross(b);
    const double facing = cross.dot(normal_), area = cross.norm();
    if (!(area > kThin * squares) || facing <= 0) return kBadTriangle;
    return squares / area + (on_one_loop(i, j, k) ? kOnOneLoop : 0.0);
  }

  // An inner corner cut off between two corners of one loop is lost for the diagonals of the others.
  bool is_last_inside(int before, int tip, int after) const {
    return !loops_.empty() && loops_[tip] < 0 && loops_[before] >= 0 && loops_[before] == loops_[after];
  }

 private:
  bool on_one_loop(int i, int j, int k) const {
    return !loops_.empty() && loops_[i] >= 0 && loops_[i] == loops_[j] && loops_[i] == loops_[k];
  }

  std::vector<Vector3d> points_;
  Vector3d normal_;
  double tie_ = 0;
  const std::vector<int>& loops_;
};

// best(i, k) = least cost of the sub-polygon i, i+1, .., k; the first of choices that cost the same is taken.
Triangles optimal(const Polygon& polygon) {
  const int n = polygon.size();
  std::vector<double> best(n * n, 0.0);
  std::vector<int> middle(n * n, -1);
  for (int width = 2; width < n; ++width) {
    for (int i = 0, k = width; k < n; ++i, ++k) {
      for (int j = i + 1; j < k; ++j) {
        const double cost = best[i * n + j] + best[j * n + k] + polygon.cost(i, j, k);
        if (j == i + 1 || cost < best[i * n + k] - polygon.tie()) best[i * n + k] = cost, middle[i * n + k] = j;
      }
    }
  }
  Triangles triangles;
  std::vector<std::array<int, 2>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const int j = middle[i * n + k];
    triangles.push_back({i, j, k});
    open.push_back({i, j});
    open.push_back({j, k});
  }
  return triangles;
}

Triangles best_ears(const Polygon& polygon) {
  struct Ear {
    double cost;
    int before, tip, after;
    bool operator>(const Ear& other) const { return cost != other.cost ? cost > other.cost : tip > other.tip; }
  };
  const int n = polygon.size();
  std::vector<int> before(n), after(n);
  for (int i = 0; i < n; ++i) before[i] = (i + n - 1) % n, after[i] = (i + 1) % n;
  std::priority_queue<Ear, std::vector<Ear>, std::greater<>> queue;
  const auto push = [&](int tip) {
    const double later = polygon.is_last_inside(before[tip], tip, after[tip]) ? kOnOneLoop / 2 : 0.0;
    queue.push({polygon.cost(before[tip], tip, after[tip]) + later, before[tip], tip, after[tip]});
  };
  for (int i = 0; i < n; ++i) push(i);
  Triangles triangles;
  while (static_cast<int>(triangles.size()) < n - 2) {
    const Ear ear = queue.top();
    queue.pop();
    if (before[ear.tip] != ear.before || after[ear.tip] != ear.after) continue;  // a neighbour has been cut off since
    std::array<int, 3> t{ear.before, ear.tip, ear.after};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
    after[ear.before] = ear.after;
    before[ear.after] = ear.before;
    before[ear.tip] = after[ear.tip] = -1;
    push(ear.before);
    push(ear.after);
  }
  return triangles;
}

}  // namespace

Triangles triangulate_polygon(const std::vector<std::array<double, 3>>& corners, const std::vector<int>& loops) {
  if (corners.size() == 3) return {{0, 1, 2}};
  const Polygon polygon(corners, loops);
  return polygon.size() <= kExactSize ? optimal(polygon) : best_ears(polygon);
}

}  // namespace holomorph::mesh
