// Points in an order that neither their numbering nor that of the faces decides.
#pragma once

#include <array>
#include <vector>

namespace holomorph::mesh {

/// Sorts the points' indices along a Z-order curve through their bounding cube (Morton 1966), so that near points are
/// near in the order. Points in one cell, of 2^-21 of the cube's side, keep the order of their numbers.
/// Cost: linear.
std::vector<int> spatial_order(const std::vector<std::array<double, 3>>& points);

}  // namespace holomorph::mesh
