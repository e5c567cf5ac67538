#include "mesh/mirror.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

constexpr double kNear = 1e-3;  // of the mean edge: places that are one
// Directions along which few vertices are level.
constexpr std::array<Point, 3> kDirections{{{0.271, 0.577, 0.770}, {0.802, -0.267, 0.534}, {-0.123, 0.696, 0.707}}};

double mean_edge(const Surface& surface) {
  double sum = 0;
  for (const double length : surface.edge_lengths) sum += length;
  return sum / static_cast<double>(surface.edge_lengths.size());
}

// Signed distances from the plane across an axis, #V.
std::vector<double> heights(const Surface& surface, int axis) {
  const auto& points = surface.polygons.vertices;
  const auto less = [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; };
  const auto [low, high] = std::ranges::minmax_element(points, less);
  const double middle = ((*low)[axis] + (*high)[axis]) / 2;
  std::vector<double> result;
  for (const Point& point : points) result.push_back(point[axis] - middle);
  return result;
}

// The polygons on the positive side; nothing where some lie across the plane, or there are not as many on both sides.
std::optional<std::vector<char>> one_half(const Surface& surface, const std::vector<double>& height,
                                          const std::vector<char>& on_plane) {
  const auto& [points, corners, offsets, file] = surface.polygons;
  std::vector<char> half(surface.face_component.size(), 0);
  std::ptrdiff_t count = 0;
  for (std::size_t f = 0; f < half.size(); ++f) {
    bool has_low = false, has_high = false;
    for (int c = offsets[f]; c < offsets[f + 1]; ++c) {
      const int v = corners[c];
      has_low = has_low || (!on_plane[v] && height[v] < 0);
      has_high = has_high || (!on_plane[v] && height[v] > 0);
    }
    if (has_low && has_high) return std::nullopt;
    half[f] = has_high ? 1 : 0;
    count += half[f];
  }
  if (2 * count != std::ssize(half)) return std::nullopt;
  return half;
}

// The one of the points at each other place, #V; nothing where there are not as many pairs of one place each.
std::optional<std::vector<int>> same_places(const std::vector<Point>& points, const std::vector<Point>& others,
                                            double near) {
  std::vector<int> found(points.size(), -1), mine(points.size());
  std::iota(mine.begin(), mine.end(), 0);
  std::vector<int> its = mine;
  for (const Point& direction : kDirections) {
    // Both in one order along a direction, but where two differ along it by less than rounding.
    const auto sort = [&](std::vector<int>& order, const std::vector<Point>& at) {
      std::ranges::stable_sort(order, {}, [&](int i) { return dot(at[i], direction); });
    };
    sort(mine, points);
    sort(its, others);
    std::vector<int> my_rest, its_rest;
    for (std::size_t k = 0; k < mine.size(); ++k) {
      if (distance(points[mine[k]], others[its[k]]) <= near) {
        found[its[k]] = mine[k];
      } else {
        my_rest.push_back(mine[k]);
        its_rest.push_back(its[k]);
      }
    }
    mine = std::move(my_rest);
    its = std::move(its_rest);
    if (mine.empty()) return found;
  }
  return std::nullopt;
}

// The corner that is each one mirrored, #C: there polygons run the other way round. Nothing where some are missing, or
// sides are not told apart by their ends.
std::optional<std::vector<int>> mirrored_corners(const Surface& surface, const std::vector<int>& twins) {
  const auto& corners = surface.polygons.corner_vertices;
  const auto& offsets = surface.polygons.face_offsets;
  std::vector<int> following(corners.size());
  std::iota(following.begin(), following.end(), 1);
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) following[offsets[f + 1] - 1] = offsets[f];
  using Key = std::pair<std::int64_t, int>;  // of a side, and the corner that it starts at
  const auto key = [&](int from, int to) { return std::int64_t{from} * surface.vertex_count + to; };
  std::vector<Key> sides;
  for (int c = 0; c < std::ssize(corners); ++c) sides.emplace_back(key(corners[c], corners[following[c]]), c);
  std::ranges::sort(sides);
  if (std::ranges::adjacent_find(sides, {}, &Key::first) != sides.end()) return std::nullopt;
  std::vector<int> result(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::int64_t wanted = key(twins[corners[following[c]]], twins[corners[c]]);
    const auto at = std::ranges::lower_bound(sides, wanted, {}, &Key::first);
    if (at == sides.end() || at->first != wanted) return std::nullopt;
    result[c] = following[at->second];
  }
  return result;
}

std::optional<Mirror> mirror_across(const Surface& surface, int axis, double near) {
  const std::vector<double> height = heights(surface, axis);
  std::vector<char> on_plane(height.size());
  std::ranges::transform(height, on_plane.begin(), [near](double h) { return std::abs(h) <= near ? 1 : 0; });
  if (std::ranges::find(on_plane, 1) == on_plane.end()) return std::nullopt;
  auto half = one_half(surface, height, on_plane);
  if (!half) return std::nullopt;
  std::vector<Point> reflected = surface.polygons.vertices;
  for (std::size_t v = 0; v < reflected.size(); ++v) reflected[v][axis] -= 2 * height[v];
  auto twins = same_places(surface.polygons.vertices, reflected, near);
  if (!twins) return std::nullopt;
  auto corners = mirrored_corners(surface, *twins);
  if (!corners) return std::nullopt;
  return Mirror{*std::move(twins), *std::move(corners), std::move(on_plane), *std::move(half)};
}

}  // namespace

std::optional<Mirror> mirror(const Surface& surface, int up) {
  if (surface.intrinsic()) return std::nullopt;
  const double near = kNear * mean_edge(surface);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == up) continue;
    if (auto found = mirror_across(surface, axis, near)) return found;
  }
  return std::nullopt;
}

}  // namespace holomorph::mesh
