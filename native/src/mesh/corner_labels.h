// Which corners of a polygon mesh may be at one vertex of a surface.
#pragma once

#include <array>
#include <vector>

namespace holomorph::mesh {

/// Corners with different labels stay apart. In a polygon labels are distinct, and no two polygons have the same set.
struct CornerLabels {
  std::vector<int> label;     ///< #C
  std::vector<int> repeated;  ///< faces that meet a vertex more than once: apart from all others
  std::vector<int> twice;     ///< faces on the vertices of an earlier one, which form sheets of their own
  std::vector<int> opposite;  ///< those of them that run the other way round
};

/// @param vertices #C vertex of each corner
/// Cost: O(#C log #C).
CornerLabels corner_labels(const std::vector<int>& vertices, const std::vector<int>& face_offsets);

/// #V the first vertex at the same place, by coordinates rounded to single precision. So copies of one vertex are found
/// again after they went through a file or a matrix. @pre finite coordinates
std::vector<int> first_at_place(const std::vector<std::array<double, 3>>& vertices);

}  // namespace holomorph::mesh
