#include "tiling/coarse_level.h"

#include <numeric>

#include "mesh/make_surface.h"
#include "progressive/levels.h"
#include "progressive/simplify.h"

namespace holomorph::tiling {

CoarseLevel coarse_level(const std::shared_ptr<const mesh::Surface>& surface, Execution& execution) {
  if (surface->triangles.size() <= kLevelTriangles || surface->intrinsic()) {
    std::vector<int> same(surface->vertex_count);
    std::iota(same.begin(), same.end(), 0);
    return {surface, std::move(same)};
  }
  const auto mesh = progressive::progressive_mesh(*surface, progressive::Order::quadric, execution);
  const int splits = progressive::split_count(mesh, kLevelTriangles);
  auto level = std::make_shared<mesh::Surface>(mesh::make_surface(progressive::level(mesh, splits), execution));
  std::vector<int> vertex(mesh.vertex_index.begin(), mesh.vertex_index.begin() + level->vertex_count);
  return {std::move(level), std::move(vertex)};
}

}  // namespace holomorph::tiling
