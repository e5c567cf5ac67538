// Lengths, areas and cotangents of single triangles, from edge lengths alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace holomorph::mesh {

/// A triangle is degenerate unless its longest side is shorter than the sum of the others by this fraction. It covers
/// the rounding of lengths from rounded positions. (Then an angle is below 1.4e-6 rad.)
inline constexpr double kDegenerateMargin = 1e-12;

/// Lengths and coordinates are at most kLargest, so that products of four do not overflow. If all are below kSmallest,
/// such products lose digits.
inline constexpr double kLargest = 1e60, kSmallest = 1e-60;

/// A triangle is degenerate, too, if its slack, the sum of the shorter sides less the longest, is below this length:
/// products of four would underflow.
inline constexpr double kLeastSlack = 1e-75;

using Point = std::array<double, 3>;

inline Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline double largest_difference(const Point& a, const Point& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

inline double distance(const Point& a, const Point& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

/// Slack below this fraction of the longest side is rounding: such a triangle is laid out without height.
inline constexpr double kFlatMargin = 1e-15;

inline bool is_degenerate(double a, double b, double c) {
  const double longest = std::max({a, b, c});
  return !((a + b + c) - 2 * longest > std::max(kDegenerateMargin * longest, kLeastSlack));
}

/// Heron's formula in Kahan's stable order; 0 where the triangle inequality fails.
inline double triangle_area(double a, double b, double c) {
  // sorted without branches, which could not be predicted
  const double higher = std::max(a, b), lower = std::min(a, b);
  const double longest = std::max(higher, c), other = std::min(higher, c);
  const double middle = std::max(lower, other), shortest = std::min(lower, other);
  const double product = (longest + (middle + shortest)) * (shortest - (longest - middle)) *
                         (shortest + (longest - middle)) * (longest + (middle - shortest));
  return product > 0 ? 0.25 * std::sqrt(product) : 0.0;
}

/// A triangle is thin where a cotangent is larger, an angle below 1.1 degrees.
inline constexpr double kThin = 50;

/// Below this fraction of the squared sides an area is rounding; it keeps every cotangent finite.
inline constexpr double kLeastArea = 1e-14;

/// Cotangent of the angle opposite side a, in a triangle of sides a, b, c and the given area.
inline double cotangent(double a, double b, double c, double area) {
  // b^2 + c^2 - a^2 as (b - a)(b + a) + c^2 keeps digits where a is nearly b
  return ((b - a) * (b + a) + c * c) / (4 * std::max(area, kLeastArea * (b * b + c * c)));
}

}  // namespace holomorph::mesh
