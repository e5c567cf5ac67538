#include "tiling/levels.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "mesh/triangle_tree.h"
#include "progressive/simplify.h"

namespace holomorph::tiling {
namespace {

std::vector<int> places_in(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  return place;
}

// Renumbers the vertices of a surface in a given order. Triangles begin with their lowest vertex and are sorted, so
// that their order does not depend on the surface's either. @param triangle_order out: #T of the surface
// @throws InvalidMesh where two triangles of its polygons have the same vertices
mesh::Surface renumbered(const mesh::Surface& surface, const std::vector<int>& order, std::vector<int>& triangle_order,
                         Execution& execution) {
  const std::vector<int> place = places_in(order);
  std::vector<std::array<double, 3>> vertices;
  vertices.reserve(order.size());
  for (const int v : order) vertices.push_back(surface.polygons.vertices[v]);
  std::vector<std::pair<mesh::Triple, int>> numbered;
  numbered.reserve(surface.triangles.size());
  for (mesh::Triple t : surface.triangles) {
    for (int& v : t) v = place[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    numbered.emplace_back(t, static_cast<int>(numbered.size()));
  }
  std::sort(numbered.begin(), numbered.end());
  std::vector<mesh::Triple> triangles;
  triangles.reserve(numbered.size());
  triangle_order.clear();
  for (const auto& [t, index] : numbered) {
    triangles.push_back(t);
    triangle_order.push_back(index);
  }
  return mesh::make_surface(progressive::triangle_polygons(std::move(vertices), triangles), execution);
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

Levels::Levels(std::shared_ptr<const mesh::Surface> surface, Execution& execution, std::vector<int> kept)
    : surface_(std::move(surface)), all_(surface_), kept_(std::move(kept)) {
  if (!surface_->intrinsic()) {
    order_ = mesh::spatial_order(surface_->polygons.vertices);
    try {
      all_ = std::make_shared<const mesh::Surface>(renumbered(*surface_, order_, triangle_order_, execution));
      return;
    } catch (const InvalidMesh&) {  // it keeps its order
    }
  }
  order_.resize(surface_->vertex_count);
  triangle_order_.resize(surface_->triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::iota(triangle_order_.begin(), triangle_order_.end(), 0);
}

void Levels::simplify(Execution& execution) const {
  if (mesh_ || surface_->intrinsic()) return;
  const Execution::Within within(execution);
  std::vector<int> kept;
  const std::vector<int> places = places_in(order_);
  for (const int v : kept_) kept.push_back(places[v]);
  try {
    mesh_ = progressive::progressive_mesh(*all_, progressive::Order::quadric, execution, kept);
  } catch (const InvalidMesh&) {  // edges with the same ends in any triangulation of its polygons: it has no levels
    return;
  }
  for (const int v : mesh_->vertex_index) vertex_.push_back(order_[v]);
  for (const int t : mesh_->triangle_index) triangle_.push_back(triangle_order_[t]);
}

CoarseLevel Levels::level(int triangles, Execution& execution) const {
  const std::lock_guard lock(one_at_a_time_);
  const bool is_small = static_cast<int>(all_->triangles.size()) <= triangles;
  if (!is_small) simplify(execution);
  CoarseLevel result{all_, order_, places_in(order_)};
  if (!is_small && mesh_) {
    result.splits = progressive::split_count(*mesh_, triangles);
    auto level =
        std::make_shared<mesh::Surface>(mesh::make_surface(progressive::level(*mesh_, result.splits), execution));
    result.vertex.assign(vertex_.begin(), vertex_.begin() + level->vertex_count);
    const std::vector<int> map = progressive::vertex_map(*mesh_, result.splits);
    for (std::size_t v = 0; v < map.size(); ++v) result.collapsed[vertex_[v]] = map[v];
    result.surface = std::move(level);
  }
  if (!surface_->intrinsic()) result.large_polygons = large_polygons(*surface_, result.vertex);
  return result;
}

}  // namespace holomorph::tiling
