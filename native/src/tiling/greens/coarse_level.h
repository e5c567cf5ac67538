// A level of the progressive mesh on which poles are searched for. Its vertices are vertices of the surface.
#pragma once

#include <memory>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::tiling {

/// On a surface with more triangles, poles are searched for on a level of about this many.
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

/// Makes the coarse level of a surface. Its vertices are numbered by their positions, so that the poles do not depend
/// on the surface's numbers. A small surface keeps all its triangles. An intrinsic surface, or one without a
/// progressive mesh, is its own level. @throws Cancelled
CoarseLevel coarse_level(const std::shared_ptr<const mesh::Surface>& surface, Execution& execution,
                         int triangles = kLevelTriangles);

}  // namespace holomorph::tiling
