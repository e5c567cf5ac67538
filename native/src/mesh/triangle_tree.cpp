#include "mesh/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

namespace holomorph::mesh {

namespace {

using Point = std::array<double, 3>;

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
  double from = 0, to = std::numeric_limits<double>::infinity();
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
