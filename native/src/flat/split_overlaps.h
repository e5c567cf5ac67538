// Splits islands that overlap themselves until none does.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::flat {

using Points = std::array<Complex, 3>;

struct Box {
  double left = kInfinity, low = left, right = -left, high = -left;

  void add(Complex z);
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && low < other.high && other.low < high;
  }
};

Box box_of(const Points& triangle);

/// Whether two triangles share more than an edge, up to a millionth of their size. Only those that are
/// counter-clockwise and have an area do.
bool overlap(const Points& a, const Points& b);

/// Numbers the parts, #F: polygons of a component with the same number are connected and do not overlap. A component
/// that does not overlap itself has one number. A part grows from a polygon by neighbours that overlap none of the
/// polygons before; the rest of the component begins anew.
/// @param surface its components are the islands. @param uv #C x 2
/// Cost: O(#T) for each number of a component. @throws Cancelled
std::vector<int> parted(const mesh::Surface& surface, const uv::UvArray& uv, Execution& execution);

}  // namespace holomorph::flat
