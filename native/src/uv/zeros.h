// Where a map is not regular: zeros of its form, and the apexes of triangles at poles.
#pragma once

#include <span>
#include <vector>

#include "mesh/stars.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

struct Zero {
  int vertex;
  int order;
};

/// Finds the zeros. The index of the form at an inner vertex is s / 2 pi - 1, at a boundary vertex s / pi - 1, where s
/// is the sum of the signed angles of its image. A flipped triangle counts 1. Together they are 2g - 2 on a closed
/// surface without poles, one more for each pole. Vertices of non-zero index and flipped triangles that touch are one
/// zero of their total order. It is named by the lowest vertex of the largest index among them, on the boundary if one
/// is there. Then what lies inside counts twice. On a surface with boundary, the orders on it plus twice the others are
/// 4g - 4 + 2b, two more for each pole. Those of order 0 are left out. The zeros in the star of a pole are counted by
/// its link, and named by a vertex of that.
/// @param uv #C x 2. @param poles simple ones, their stars apart from each other and from the boundary
std::vector<Zero> zeros(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv,
                        const std::vector<int>& poles);

/// Gives each triangle (p, a, b) of the stars an apex of its own, by the similarity that takes its link side to its
/// UVs. It is uv_a + z (uv_b - uv_a), z the position of p where a is 0 and b is 1. So the angles of these triangles are
/// exact, their UVs finite, and the spokes are seams.
/// @param surface the triangulation of the stars, in which no diagonal ends at a pole
/// @param uv #C x 2, changed at the corners of the poles only
void place_apexes(const mesh::Surface& surface, std::span<const mesh::Star> stars, Eigen::Ref<UvArray> uv);

}  // namespace holomorph::uv
