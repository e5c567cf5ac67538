#include "mesh/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "base/constants.h"
#include "base/workers.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {

namespace {

using Eigen::Vector3d;

constexpr int kRays = 128;         // over the whole sphere, of which half are above a vertex
constexpr double kLowest = 0.1;    // least cosine with the normal: lower rays meet the faces around the vertex
constexpr double kRay = 1000;      // operations, about
constexpr double kBegin = 0.0025;  // height above the vertex where rays begin, in square roots of the area

// Direction i of a Fibonacci lattice on the sphere, nearly evenly spread.
Vector3d direction(int i) {
  const double z = 1 - (2 * i + 1.0) / kRays, radius = std::sqrt(1 - z * z);
  const double angle = kTwoPi * std::numbers::phi * i;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

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

constexpr int kBits = 21;  // for each coordinate
constexpr int kDigit = 16, kDigits = 4;

// The bits of a coordinate, two zeros after each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

std::vector<std::uint64_t> keys(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double cells = side > 0 ? ((1 << kBits) - 1) / side : 0;
  std::vector<std::uint64_t> result;
  result.reserve(points.size());
  for (const Point& p : points) {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) key |= spread(static_cast<std::uint64_t>((p[i] - low[i]) * cells)) << i;
    result.push_back(key);
  }
  return result;
}

}  // namespace

AmbientOcclusion::AmbientOcclusion(const Surface& surface, const std::optional<std::array<double, 3>>& up)
    : surface_(surface), tree_(surface), normals_(surface.vertex_count, Vector3d::Zero()), weights_(kRays, 1) {
  for (int i = 0; up && i < kRays; ++i)
    weights_[i] = std::clamp(0.5 + direction(i).dot(Vector3d(up->data())), 0.0, 1.0);
  double area = 0;
  for (const Triple& t : surface.triangles) {
    std::array<Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = Vector3d(surface.polygons.vertices[t[i]].data());
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]) / 2;
    area += normal.norm();
    for (const int v : t) normals_[v] += normal;
  }
  for (Vector3d& normal : normals_) normal = normal.stableNormalized();
  begin_ = kBegin * std::sqrt(area);
}

void AmbientOcclusion::prepare(const std::vector<int>& vertices, Workers& workers) {
  std::vector<int> missing;
  for (const int v : vertices) {
    if (known_.emplace(v, 0).second) missing.push_back(v);
  }
  Execution::count(kRay * kRays / 2 * static_cast<double>(missing.size()));
  std::vector<double> values(missing.size());
  run_throwing(workers, static_cast<int>(missing.size()), [&](int i) { values[i] = found(missing[i]); });
  for (std::size_t i = 0; i < missing.size(); ++i) known_[missing[i]] = values[i];
}

double AmbientOcclusion::found(int vertex) const {
  const Vector3d& normal = normals_[vertex];
  const Vector3d start = Vector3d(surface_.polygons.vertices[vertex].data()) + begin_ * normal;
  double all = 0, open = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vector3d ray = direction(i);
    const double cosine = ray.dot(normal);
    if (cosine < kLowest) continue;
    all += cosine;
    if (weights_[i] > 0 && !tree_.meets(start, ray, 0)) open += weights_[i] * cosine;
  }
  return all > 0 ? open / all : 1;
}

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

// By their keys, digit by digit from the lowest on.
std::vector<int> spatial_order(const std::vector<Point>& points) {
  std::vector<int> order(points.size()), next(points.size());
  std::iota(order.begin(), order.end(), 0);
  if (points.empty()) return order;
  const std::vector<std::uint64_t> key = keys(points);
  const auto digit = [&](int point, int which) { return key[point] >> (which * kDigit) & ((1 << kDigit) - 1); };
  for (int which = 0; which < kDigits; ++which) {
    std::vector<int> place((1 << kDigit) + 1, 0);
    for (const int i : order) ++place[digit(i, which) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (const int i : order) next[place[digit(i, which)]++] = i;
    order.swap(next);
  }
  return order;
}

namespace {

using Eigen::Vector3d;

constexpr int kLeaf = 4;        // triangles at most in a leaf
constexpr int kDeepest = 64;    // the tree is balanced
constexpr double kEdge = 1e-9;  // barycentric: a ray through an edge meets both triangles rather than none

// Möller and Trumbore 1997.
bool meets_triangle(const Vector3d& start, const Vector3d& direction, double begin,
                    const std::array<Vector3d, 3>& corners) {
  const Vector3d e = corners[1] - corners[0], f = corners[2] - corners[0], p = direction.cross(f);
  const double determinant = e.dot(p);
  if (determinant == 0) return false;
  const Vector3d s = start - corners[0], q = s.cross(e);
  const double u = s.dot(p) / determinant, v = direction.dot(q) / determinant;
  return u >= -kEdge && v >= -kEdge && u + v <= 1 + kEdge && f.dot(q) / determinant > begin;
}

// The slab method: the ray meets the box if its intervals between the three pairs of planes have a common point.
bool meets_box(const Vector3d& start, const Vector3d& inverse, const Eigen::AlignedBox3d& box) {
  double from = 0, to = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min()[i] - start[i]) * inverse[i], b = (box.max()[i] - start[i]) * inverse[i];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

}  // namespace

TriangleTree::TriangleTree(std::span<const std::array<double, 3>> vertices, std::span<const Triple> triangles) {
  std::vector<Corners> corners;
  std::vector<std::array<double, 3>> centres;
  for (const Triple& t : triangles) {
    Corners& own = corners.emplace_back();
    for (int i = 0; i < 3; ++i) own[i] = Vector3d(vertices[t[i]].data());
    const Vector3d centre = (own[0] + own[1] + own[2]) / 3;
    centres.push_back({centre[0], centre[1], centre[2]});
  }
  // Triangles near each other in this order are near each other in space: halving the list halves the boxes.
  order_ = spatial_order(centres);
  for (const int t : order_) corners_.push_back(corners[t]);
  build(0, 0, static_cast<int>(order_.size()));
}

void TriangleTree::build(std::size_t node, int first, int end) {
  // An implicit binary tree: the children of node n are 2 n + 1 and 2 n + 2.
  if (nodes_.size() <= node) nodes_.resize(2 * node + 1);
  if (end - first > kLeaf) {
    const int middle = first + (end - first) / 2;
    build(2 * node + 1, first, middle);
    build(2 * node + 2, middle, end);
    nodes_[node] = {nodes_[2 * node + 1].box.merged(nodes_[2 * node + 2].box), first, end};
    return;
  }
  nodes_[node] = {{}, first, end};
  for (int i = first; i < end; ++i) {
    for (const Vector3d& p : corners_[i]) nodes_[node].box.extend(p);
  }
}

void TriangleTree::find_near(const Eigen::AlignedBox3d& box, std::vector<int>& found) const {
  std::array<std::size_t, kDeepest> stack;
  std::size_t height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const std::size_t n = stack[--height];
    const Node& node = nodes_[n];
    if (!node.box.intersects(box)) continue;
    if (node.end - node.first > kLeaf) {
      stack[height++] = 2 * n + 2;
      stack[height++] = 2 * n + 1;
      continue;
    }
    found.insert(found.end(), order_.begin() + node.first, order_.begin() + node.end);
  }
}

bool TriangleTree::meets(const Vector3d& start, const Vector3d& direction, double begin) const {
  const Vector3d inverse = direction.cwiseInverse();
  std::array<std::size_t, kDeepest> stack;
  std::size_t height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const std::size_t n = stack[--height];
    const Node& node = nodes_[n];
    if (!meets_box(start, inverse, node.box)) continue;
    if (node.end - node.first > kLeaf) {
      stack[height++] = 2 * n + 2;
      stack[height++] = 2 * n + 1;
      continue;
    }
    for (int i = node.first; i < node.end; ++i) {
      if (meets_triangle(start, direction, begin, corners_[i])) return true;
    }
  }
  return false;
}

}  // namespace holomorph::mesh
