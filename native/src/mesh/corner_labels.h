// Which corners of a polygon mesh may be at one vertex of a surface.
#pragma once

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

}  // namespace holomorph::mesh
