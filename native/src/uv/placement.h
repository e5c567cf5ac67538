// The frame of a UV map in the plane, and similarities of the map.
#pragma once

#include <complex>

#include "base/workers.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

struct Frame {
  std::complex<double> low, high;  ///< corners of the bounding box, u + i v
  double area = 0;                 ///< sum of the absolute areas of the triangles
};

/// Computes the frame of the map rotated by an angle about 0. @param uv #C x 2. @param rotation radians,
/// counter-clockwise
/// The area is summed in a fixed order. Cost: O(#T).
Frame frame(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, double rotation, Workers& workers);

/// Maps z to factor (z - origin) + target: centred first, so that equal u or v of corners remain equal.
struct Placement {
  std::complex<double> factor, origin, target;
};

/// Writes the placed map into a larger array of corners.
/// @param uv #C x 2. @param rows #C row of `placed` of each corner, all different; null: row c of corner c
/// @param placed two numbers in each row
void place(const Eigen::Ref<const UvArray>& uv, const Placement& placement, const int* rows, double* placed,
           Workers& workers);

}  // namespace holomorph::uv
