#include "islands/flat_triangles.h"

#include <algorithm>
#include <cmath>

namespace holomorph::islands {
namespace {

constexpr double kTouching = 1e-6;     // largest depth of two triangles that only touch, over their size
constexpr double kLeastWidth = 1e-12;  // least width of a triangle: twice its area over its squared sides

double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }

// Whether a side of `a` separates the two triangles, up to kTouching. Convex figures in the plane are apart if and only
// if a side of one of them separates them.
bool side_parts(const Points& a, const Points& b) {
  for (int i = 0; i < 3; ++i) {
    const Complex side = a[(i + 1) % 3] - a[i];
    const double length = std::abs(side);
    if (!(length > 0)) continue;
    double deepest = 0, inner = 0;
    for (int j = 0; j < 3; ++j) {
      deepest = std::max(deepest, cross(side, b[j] - a[i]) / length);
      inner = std::max(inner, cross(side, a[j] - a[i]) / length);
    }
    if (deepest <= kTouching * std::max(length, inner)) return true;
  }
  return false;
}

}  // namespace

void Box::add(Complex z) {
  left = std::min(left, z.real()), right = std::max(right, z.real());
  low = std::min(low, z.imag()), high = std::max(high, z.imag());
}

Box box_of(const Points& triangle) {
  Box box;
  for (const Complex z : triangle) box.add(z);
  return box;
}

bool overlap(const Points& a, const Points& b) {
  for (const Points* t : {&a, &b}) {
    const Complex one = (*t)[1] - (*t)[0], other = (*t)[2] - (*t)[0];
    if (!(cross(one, other) > kLeastWidth * (std::norm(one) + std::norm(other)))) return false;
  }
  return !side_parts(a, b) && !side_parts(b, a);
}

}  // namespace holomorph::islands
