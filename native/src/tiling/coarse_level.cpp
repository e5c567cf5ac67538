#include "tiling/coarse_level.h"

#include <numeric>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "progressive/levels.h"
#include "progressive/simplify.h"

namespace holomorph::tiling {

namespace {

CoarseLevel the_surface_itself(const std::shared_ptr<const mesh::Surface>& surface) {
  std::vector<int> same(surface->vertex_count);
  std::iota(same.begin(), same.end(), 0);
  return {surface, same, same};
}

}  // namespace

CoarseLevel coarse_level(const std::shared_ptr<const mesh::Surface>& surface, Execution& execution) {
  if (surface->triangles.size() <= kLevelTriangles || surface->intrinsic()) return the_surface_itself(surface);
  progressive::ProgressiveMesh mesh;
  try {
    mesh = progressive::progressive_mesh(*surface, progressive::Order::quadric, execution);
  } catch (const InvalidMesh&) {  // edges with the same ends in any triangulation of its polygons: it has no levels
    return the_surface_itself(surface);
  }
  const int splits = progressive::split_count(mesh, kLevelTriangles);
  auto level = std::make_shared<mesh::Surface>(mesh::make_surface(progressive::level(mesh, splits), execution));
  std::vector<int> vertex(mesh.vertex_index.begin(), mesh.vertex_index.begin() + level->vertex_count);
  const std::vector<int> map = progressive::vertex_map(mesh, splits);
  std::vector<int> collapsed(surface->vertex_count);
  for (std::size_t v = 0; v < map.size(); ++v) collapsed[mesh.vertex_index[v]] = map[v];
  return {std::move(level), std::move(vertex), std::move(collapsed)};
}

}  // namespace holomorph::tiling
