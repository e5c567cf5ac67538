#include "flat/flattening.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "flat/free_boundary.h"
#include "mesh/components.h"
#include "uv/evening.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

using Rows = Eigen::Index;

// A map whose scale factors all lie within this part of 1 stretches nothing that could be seen.
constexpr double kUnseen = 1e-3;

bool is_disk(const mesh::Surface& island) {
  const auto type = mesh::topological_type(island);
  return type.genus == 0 && type.boundary_count == 1;
}

// Calls visit(k, island) for each island in turn. Its part of the progress is its share of the triangles.
template <class Visit>
void for_islands(const std::vector<mesh::Component>& islands, Execution& execution, const Visit& visit) {
  double all = 1, done = 0;
  for (const auto& island : islands) all += static_cast<double>(island.surface.triangles.size());
  for (std::size_t k = 0; k < islands.size(); ++k) {
    const double share = static_cast<double>(islands[k].surface.triangles.size()) / all;
    execution.part(done, done + share);
    const Execution::Within within(execution);
    visit(k, islands[k]);
    done += share;
  }
}

// Writes the map of an island, and its scale factors.
void write(const mesh::Component& island, const flat::PlaneMap& map, Flattening& result) {
  const auto& vertices = island.surface.polygons.corner_vertices;
  for (std::size_t c = 0; c < vertices.size(); ++c) {
    const auto z = map.points[vertices[c]];
    result.uv.row(island.corner_index[c]) << z.real(), z.imag();
  }
  for (std::size_t v = 0; v < island.vertex_index.size(); ++v)
    result.scale_factors[island.vertex_index[v]] = map.scale_factors[static_cast<Rows>(v)];
}

uv::UvArray rows_of(const mesh::Component& island, const uv::UvArray& uv) {
  uv::UvArray result(static_cast<Rows>(island.corner_index.size()), 2);
  for (std::size_t c = 0; c < island.corner_index.size(); ++c)
    result.row(static_cast<Rows>(c)) = uv.row(island.corner_index[c]);
  return result;
}

bool stretches(const mesh::Component& island, const std::vector<double>& scale_factors) {
  // Negated, so that a scale factor that is not a number counts as stretch.
  return std::any_of(island.vertex_index.begin(), island.vertex_index.end(),
                     [&](int v) { return !(std::abs(scale_factors[v] - 1) <= kUnseen); });
}

void even(const mesh::Surface& island, double evenness, uv::UvArray& uv, Execution& execution) {
  try {
    const uv::UvArray delta = uv::evened(island, uv, {}, evenness, execution);
    const auto& vertices = island.polygons.corner_vertices;
    for (std::size_t c = 0; c < vertices.size(); ++c) uv.row(static_cast<Rows>(c)) += delta.row(vertices[c]);
  } catch (const SolverError&) {  // the island stays conformal
  }
}

}  // namespace

Flattening flattened(const mesh::Surface& surface, Execution& execution) {
  const auto islands = mesh::components(surface, execution);
  Flattening result{uv::UvArray::Zero(static_cast<Rows>(surface.polygons.corner_vertices.size()), 2),
                    std::vector<double>(surface.vertex_count, 1.0), std::vector<char>(islands.size(), 0)};
  execution.stage("islands", 0.0, 1.0);
  for_islands(islands, execution, [&](std::size_t k, const mesh::Component& island) {
    if (!is_disk(island.surface)) return;
    try {
      write(island, flat::free_boundary_map(island.surface, {}, execution), result);
      result.is_flat[k] = 1;
    } catch (const SolverError&) {  // is_flat stays 0: the caller is told
    }
  });
  execution.finish();
  return result;
}

uv::UvArray evened(const mesh::Surface& surface, const Flattening& flattening, double evenness, Execution& execution) {
  const auto islands = mesh::components(surface, execution);
  uv::UvArray result = flattening.uv;
  execution.stage("evening", 0.0, 1.0);
  for_islands(islands, execution, [&](std::size_t, const mesh::Component& island) {
    if (!stretches(island, flattening.scale_factors)) return;
    uv::UvArray uv = rows_of(island, flattening.uv);
    if (evenness > 0) even(island.surface, evenness, uv, execution);
    // An island that is stretched gets the area in the plane that it has on the surface. Without an area in the plane
    // it stays as it was flattened.
    const double scale = std::sqrt(mesh::area(island.surface, execution.workers()) /
                                   uv::frame(island.surface, uv, 0.0, execution.workers()).area);
    if (!std::isfinite(scale)) return;
    for (std::size_t c = 0; c < island.corner_index.size(); ++c)
      result.row(island.corner_index[c]) = scale * uv.row(static_cast<Rows>(c));
  });
  execution.finish();
  return result;
}

}  // namespace holomorph::flat
