#include "tiling/greens/coarse_level.h"

#include <algorithm>
#include <numeric>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "mesh/triangle_tree.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"

namespace holomorph::tiling {
namespace {

CoarseLevel the_surface_itself(const std::shared_ptr<const mesh::Surface>& surface) {
  std::vector<int> same(surface->vertex_count);
  std::iota(same.begin(), same.end(), 0);
  return {surface, same, same};
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  return place;
}

// Renumbers the vertices of a surface in a given order. Triangles begin with their lowest vertex and are sorted, so
// that their order does not depend on the surface's either.
// @throws InvalidMesh where two triangles of its polygons have the same vertices
mesh::Surface renumbered(const mesh::Surface& surface, const std::vector<int>& order, Execution& execution) {
  const std::vector<int> place = inverse(order);
  std::vector<std::array<double, 3>> vertices;
  vertices.reserve(order.size());
  for (const int v : order) vertices.push_back(surface.polygons.vertices[v]);
  std::vector<mesh::Triple> triangles(surface.triangles.begin(), surface.triangles.end());
  for (mesh::Triple& t : triangles) {
    for (int& v : t) v = place[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return mesh::make_surface(progressive::triangle_polygons(std::move(vertices), triangles), execution);
}

CoarseLevel level_of(const std::shared_ptr<const mesh::Surface>& all, const std::vector<int>& order, int triangles,
                     Execution& execution) {
  if (static_cast<int>(all->triangles.size()) <= triangles) return {all, order, inverse(order)};
  const Execution::Within within(execution);
  const auto levels = progressive::progressive_mesh(*all, progressive::Order::quadric, execution);
  const int splits = progressive::split_count(levels, triangles);
  auto level = std::make_shared<mesh::Surface>(mesh::make_surface(progressive::level(levels, splits), execution));
  std::vector<int> vertex, collapsed(all->vertex_count);
  for (int v = 0; v < level->vertex_count; ++v) vertex.push_back(order[levels.vertex_index[v]]);
  const std::vector<int> map = progressive::vertex_map(levels, splits);
  // vertex_index leads from the progressive mesh to `all`, `order` from there to the surface.
  for (std::size_t v = 0; v < map.size(); ++v) collapsed[order[levels.vertex_index[v]]] = map[v];
  return {std::move(level), std::move(vertex), std::move(collapsed)};
}

std::vector<std::vector<int>> large_polygons(const mesh::Surface& surface, const std::vector<int>& level_vertex) {
  std::vector<int> place(surface.vertex_count, -1);
  for (std::size_t v = 0; v < level_vertex.size(); ++v) place[level_vertex[v]] = static_cast<int>(v);
  std::vector<std::vector<int>> result;
  const auto& [positions, corner_vertices, offsets, file] = surface.polygons;
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    if (offsets[f + 1] - offsets[f] <= 4) continue;
    std::vector<int> corners;
    for (auto c = offsets[f]; c < offsets[f + 1]; ++c) {
      if (const int v = place[corner_vertices[c]]; v >= 0) corners.push_back(v);
    }
    if (corners.size() > 1) result.push_back(std::move(corners));
  }
  return result;
}

}  // namespace

CoarseLevel coarse_level(const std::shared_ptr<const mesh::Surface>& surface, Execution& execution, int triangles) {
  if (surface->intrinsic()) return the_surface_itself(surface);
  // Vertices in an order of space, so that the level does not depend on the order of the mesh's elements.
  std::vector<int> order = mesh::spatial_order(surface->polygons.vertices);
  std::shared_ptr<const mesh::Surface> all;
  try {
    all = std::make_shared<const mesh::Surface>(renumbered(*surface, order, execution));
  } catch (const InvalidMesh&) {  // it keeps its order
    all = surface;
    std::iota(order.begin(), order.end(), 0);
  }
  try {
    CoarseLevel level = level_of(all, order, triangles, execution);
    level.large_polygons = large_polygons(*surface, level.vertex);
    return level;
  } catch (const InvalidMesh&) {  // edges with the same ends in any triangulation of its polygons: it has no levels
    return the_surface_itself(surface);
  }
}

}  // namespace holomorph::tiling
