// A level of the progressive mesh on which poles are looked for: its vertices are vertices of the surface.
#pragma once

#include <memory>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::tiling {

/// From this many triangles on poles are looked for on a level of about as many.
inline constexpr int kLevelTriangles = 10'000;

struct CoarseLevel {
  std::shared_ptr<const mesh::Surface> surface;
  std::vector<int> vertex;     ///< #V of the level: the same vertex of the surface
  std::vector<int> collapsed;  ///< #V of the surface: the vertex of the level that it was collapsed into
  /// The corners that are vertices of the level, for each polygon of the surface with more than four.
  std::vector<std::vector<int>> large_polygons = {};

  /// Whether the level has all triangles of the surface.
  bool is_whole(const mesh::Surface& all) const { return surface->triangles.size() == all.triangles.size(); }
};

/// Numbered by the positions of the vertices, so that the poles do not depend on how the surface numbers them. All its
/// triangles where it is small; the surface itself where it is intrinsic or has no progressive mesh. @throws Cancelled
CoarseLevel coarse_level(const std::shared_ptr<const mesh::Surface>& surface, Execution& execution);

}  // namespace holomorph::tiling
