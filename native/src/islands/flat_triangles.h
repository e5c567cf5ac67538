// Triangles in the plane, and whether two of them overlap.
#pragma once

#include <array>
#include <complex>
#include <limits>

namespace holomorph::islands {

using Complex = std::complex<double>;
using Points = std::array<Complex, 3>;

struct Box {
  double left = std::numeric_limits<double>::infinity(), low = left, right = -left, high = -left;

  void add(Complex z);
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && low < other.high && other.low < high;
  }
};

Box box_of(const Points& triangle);

/// Whether two triangles share more than an edge, up to a millionth of their size. Only those that are
/// counter-clockwise and have an area do.
bool overlap(const Points& a, const Points& b);

}  // namespace holomorph::islands
