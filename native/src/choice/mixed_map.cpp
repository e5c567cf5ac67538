#include "choice/mixed_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "flat/arrangement.h"
#include "mesh/facets.h"
#include "mesh/hard_edges.h"

namespace holomorph::choice {
namespace {

std::vector<flat::Laid> laid(const std::vector<MappedPiece>& pieces) {
  std::vector<flat::Laid> result;
  for (const auto& [piece, map] : pieces) {
    result.push_back({map->part()->surface.get(),
                      map->part()->area,
                      {map->uv().data(), map->uv().rows(), 2},
                      map->density(),
                      map->is_tiled(),
                      map->turns(),
                      piece->corner_index.data()});
  }
  return result;
}

uv::Quality joined_quality(const std::vector<MappedPiece>& pieces, double unit, Workers& workers) {
  std::vector<const uv::Quality*> qualities;
  std::vector<double> densities;
  for (const MappedPiece& each : pieces) {
    qualities.push_back(&each.map->quality());
    densities.push_back(each.map->tiling() ? each.map->density() : std::pow(unit, -2));
  }
  return uv::joined(qualities, densities, workers);
}

SeamlessPointer of_part(SeamlessMap tiling, const std::vector<int>& vertex_index) {
  for (int& v : tiling.poles) v = vertex_index[v];
  for (uv::Zero& zero : tiling.zeros) zero.vertex = vertex_index[zero.vertex];
  for (mesh::Pair& ends : tiling.seams) ends = {vertex_index[ends[0]], vertex_index[ends[1]]};
  for (int& v : tiling.cones) v = vertex_index[v];
  return std::make_shared<const SeamlessMap>(std::move(tiling));
}

struct Seams {
  std::vector<char> is_border;    // #E, whether a texture breaks off
  std::vector<mesh::Pair> edges;  // vertices of those where the UVs jump
};

Seams seams_of(const mesh::Surface& surface, const std::vector<MappedPiece>& pieces, Execution& execution) {
  std::vector<mesh::Pair> borders, whole;  // where it breaks off, and where it jumps by whole tiles
  for (const auto& [piece, map] : pieces) {
    const auto add = [&index = piece->vertex_index](std::vector<mesh::Pair>& pairs, const mesh::Pair& ends) {
      pairs.push_back({index[ends[0]], index[ends[1]]});
    };
    const mesh::Surface& own = *map->part()->surface;
    for (std::size_t e = 0; e < own.edges.size(); ++e) {
      if (own.edge_face_count[e] == 1) add(borders, own.edges[e]);
    }
    for (const mesh::Pair& ends : map->seams(execution)) add(map->tiling() ? whole : borders, ends);
  }
  borders = sorted_pairs(std::move(borders));
  whole = sorted_pairs(std::move(whole));
  Seams result{std::vector<char>(surface.edges.size(), 0), {}};
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const auto [a, b] = surface.edges[e];
    if (surface.edge_face_count[e] != 2) continue;
    result.is_border[e] = holds(borders, a, b);
    if (result.is_border[e] || holds(whole, a, b)) result.edges.push_back(surface.edges[e]);
  }
  return result;
}

// Lengths of seams across the smooth, or what is seen of a `cut`, and of hidden ones, over the root of the area.
std::pair<double, double> seen_lengths(const Part& part, const std::vector<char>& is_border,
                                       const std::optional<double>& cut) {
  const std::vector<double> breaks = mesh::breaks(*part.surface);
  double all = 0, seen = 0;
  for (std::size_t e = 0; e < is_border.size(); ++e) {
    if (!is_border[e]) continue;
    all += part.surface->edge_lengths[e];
    seen += part.surface->edge_lengths[e] * mesh::seen(breaks[e]);
  }
  const double size = std::sqrt(part.area), soft = cut ? *cut : seen / size;
  return {soft, all / size - soft};
}

std::string why(const Mixed& made, std::size_t pieces, bool is_cut) {
  const std::size_t tiled = made.tilings.size();
  const std::string range = ": size range " + size_range(made.quality);
  if (is_cut) return "cut open where it is hardly seen it has whole tiles" + range;
  const std::string has =
      tiled == 1 ? "1 piece between hard edges has" : std::to_string(tiled) + " pieces between hard edges have";
  return has + " whole tiles" + (tiled < pieces ? ", the rest flattens" : "") + range;
}

}  // namespace

MapPointer mixed_map(const PartPointer& part, const StructurePointer& structure, const std::vector<MappedPiece>& pieces,
                     double evenness, const std::optional<double>& cut, Execution& execution) {
  const std::vector<flat::Laid> maps = laid(pieces);
  const double unit = flat::unit_length(maps, {}, execution.workers());
  auto made = std::make_shared<Mixed>();
  made->uv =
      flat::arranged(maps, static_cast<int>(part->surface->polygons.corner_vertices.size()), {}, execution.workers());
  made->quality = joined_quality(pieces, unit, execution.workers());
  for (const auto& [piece, map] : pieces) {
    if (map->tiling()) made->tilings.push_back(of_part(*map->tiling(), piece->vertex_index));
  }
  Seams seams = seams_of(*part->surface, pieces, execution);
  made->seams = std::move(seams.edges);
  made->evenness = evenness;
  std::tie(made->soft_length, made->hard_length) = seen_lengths(*part, seams.is_border, cut);
  std::string reason = why(*made, pieces.size(), cut.has_value());
  return std::make_shared<const Map>(part, structure, std::move(made), std::move(reason), execution);
}

}  // namespace holomorph::choice
