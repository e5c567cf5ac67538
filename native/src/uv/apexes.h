// UVs of the triangles at poles, where the map is infinite.
#pragma once

#include <span>

#include "mesh/stars.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// Gives each triangle (p, a, b) of the stars an apex of its own, by the similarity that takes its link side to its
/// UVs. It is uv_a + z (uv_b - uv_a), z the position of p where a is 0 and b is 1. So the angles of these triangles are
/// exact, their UVs finite, and the spokes are seams.
/// @param surface the triangulation of the stars, in which no diagonal ends at a pole
/// @param uv #C x 2, changed at the corners of the poles only
void place_apexes(const mesh::Surface& surface, std::span<const mesh::Star> stars, Eigen::Ref<UvArray> uv);

}  // namespace holomorph::uv
