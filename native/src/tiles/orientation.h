// On which side of a line a point lies, decided exactly.
#pragma once

#include <array>

#include "base/double_double.h"

namespace holomorph::tiles {

using Point = std::array<double, 2>;

/// Largest coordinate. Differences of coordinates are exact, and products are exact in twice the precision.
inline constexpr double kLargestCoordinate = 0x1p50;

/// a d - b c, rounded, with the right sign and exactly 0 where it is. @pre integers up to 2 kLargestCoordinate
inline double determinant(double a, double b, double c, double d) {
  const DoubleDouble p = exact_product(a, d), q = exact_product(b, c);
  // Where the first difference is rounded, it is more than the second; else the sum is one of integers.
  return (p.high - q.high) + (p.low - q.low);
}

/// Twice the signed area of (a, b, x): positive where x lies on the left of the line from a to b.
inline double orientation(const Point& a, const Point& b, const Point& x) {
  return determinant(b[0] - a[0], b[1] - a[1], x[0] - a[0], x[1] - a[1]);
}

}  // namespace holomorph::tiles
