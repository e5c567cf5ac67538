// Joins flat islands edge to edge into nets that do not overlap.
#pragma once

#include <array>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::islands {

/// The two polygon sides at one edge of the surface before it was cut open. Corners at the start and end of the one
/// side, then of the other; each side has its polygon on the left.
using Joint = std::array<int, 4>;

/// Moves islands rigidly so that the sides of a joint coincide, one joint after the other. Skips a joint unless its
/// sides have equal lengths and belong to different nets that then do not overlap, and no island that is held would be
/// turned by more than 5 degrees, all in all.
/// @param surface cut open along its seams. @param uv #C x 2, changed. @param joints in the order in which they are
/// tried
/// @param is_joinable each component: whether it may be moved. @param is_held each one: whether it keeps its direction
/// @return each component: the lowest one of its net. @throws Cancelled
/// Cost: at most kMostTriangles tests of two triangles for each triangle of the surface.
std::vector<int> joined(const mesh::Surface& surface, uv::UvArray& uv, const std::vector<Joint>& joints,
                        const std::vector<char>& is_joinable, const std::vector<char>& is_held, Execution& execution);

}  // namespace holomorph::islands
