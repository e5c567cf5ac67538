#include "choice/pieces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "choice/untiled.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

/// Radians of curvature without tips, from which on a piece that is not a tube is more than sheets and cones.
constexpr double kSmooth = 1;
constexpr double kTubes = 0.5;  // part of the area of a part without islands, from which on its tubes are looked at
constexpr int kEnds = 2;        // the longest boundary loops of a tube

std::vector<int> labels_of(const Part& part, const std::vector<int>& vertices) {
  std::vector<int> result = vertices;
  for (int& v : result) v = part.labels.empty() ? v : part.labels[v];
  return result;
}

std::vector<Piece> pieces_of(const Part& part, std::vector<mesh::Component> components, Execution& execution) {
  std::vector<Piece> result;
  for (mesh::Component& each : components) {
    auto surface = std::make_shared<const mesh::Surface>(std::move(each.surface));
    PartPointer own = part_of(std::move(surface), part.up, labels_of(part, each.vertex_index), execution);
    result.push_back({std::move(own),
                      std::move(each.vertex_index),
                      std::move(each.face_index),
                      std::move(each.corner_index),
                      0,
                      {},
                      kInfinity});
  }
  return result;
}

bool may_be_smooth(const Part& part, bool has_islands) {
  const double curved = mesh::curvature(*part.surface, {}, mesh::kTip);
  const auto& [genus, boundaries] = part.type;
  const bool is_round = genus == 0 && boundaries > 1;  // a tube, perhaps with windows
  return curved <= kMostCurved && (is_round || (has_islands && boundaries > 0 && curved > kSmooth));
}

// The length of the seams of islands across the smooth. @param seams sorted pairs of vertices of the whole part
double soft_length(const Piece& piece, const std::vector<mesh::Pair>& seams) {
  const mesh::Surface& surface = *piece.part->surface;
  const std::vector<double> breaks = mesh::breaks(surface);
  double result = 0;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const auto [a, b] = surface.edges[e];
    if (surface.edge_face_count[e] == 2 && holds(seams, piece.vertex_index[a], piece.vertex_index[b]))
      result += surface.edge_lengths[e] * mesh::seen(breaks[e]);
  }
  return result;
}

// Whether the islands have a seam across the smooth, longer than `most`, or stretch, or do not stand upright. Gives the
// piece what is theirs.
bool is_minded(Piece& piece, const flat::Layout& flat, const std::vector<mesh::Pair>& seams, double most,
               Execution& execution) {
  const mesh::Surface& surface = *piece.part->surface;
  uv::UvArray& uv = piece.uv.emplace(static_cast<Eigen::Index>(piece.corner_index.size()), 2);
  for (std::size_t c = 0; c < piece.corner_index.size(); ++c)
    uv.row(static_cast<Eigen::Index>(c)) = flat.uv.row(piece.corner_index[c]);
  uv::Quality quality = uv::quality(surface, uv, execution.workers());
  if (flat.quality.direction && piece.part->has_positions())
    quality.direction = uv::direction(surface, uv, piece.part->up, 1, execution.workers());
  const double soft = soft_length(piece, seams);
  piece.cost = uv::cost(quality, {.soft_seams = soft / std::sqrt(piece.part->area)});
  return soft > most || piece.cost > kFlat;
}

// The tiling without the seams that ran through windows, and the cones at their rims.
SeamlessMap inside(const SeamlessMap& tiling, const mesh::Surface& surface) {
  std::vector<mesh::Pair> inner;
  std::vector<char> is_rim(surface.vertex_count, 0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] == 2) {
      inner.push_back(surface.edges[e]);
    } else {
      for (const int v : surface.edges[e]) is_rim[v] = 1;
    }
  }
  inner = sorted_pairs(std::move(inner));
  SeamlessMap result = tiling;
  result.seams.clear();
  result.jumps.clear();
  for (std::size_t k = 0; k < tiling.seams.size(); ++k) {
    if (!holds(inner, tiling.seams[k][0], tiling.seams[k][1])) continue;
    result.seams.push_back(tiling.seams[k]);
    if (!tiling.jumps.empty()) result.jumps.push_back(tiling.jumps[k]);
  }
  result.cones.clear();
  result.cone_angles.clear();
  for (std::size_t k = 0; k < tiling.cones.size(); ++k) {
    if (is_rim[tiling.cones[k]]) continue;
    result.cones.push_back(tiling.cones[k]);
    result.cone_angles.push_back(tiling.cone_angles[k]);
  }
  return result;
}

}  // namespace

double turn_against(const Piece& piece, const uv::UvArray& other) {
  return piece.uv ? flat::turn_between(*piece.part->surface, *piece.uv, other) : 0;
}

std::vector<Piece> cut_apart(const Part& part, const std::vector<int>& names, Execution& execution) {
  std::vector<Piece> result = pieces_of(part, flat::cut_apart(*part.surface, names, execution), execution);
  for (Piece& piece : result) piece.name = names[piece.face_index.front()];
  return result;
}

std::optional<std::pair<Piece, double>> cut_in_hiding(const Part& part, bool is_upright, Execution& execution) {
  std::optional<std::array<double, 3>> up;
  if (is_upright) up.emplace()[static_cast<int>(part.up)] = 1;
  auto [components, seen] = flat::cut_in_hiding(*part.surface, up, execution);
  if (components.size() != 1) return {};
  return std::pair(std::move(pieces_of(part, std::move(components), execution).front()), seen);
}

std::vector<Piece> smooth_pieces(const Part& part, const flat::Layout* flat, const std::vector<int>& names,
                                 Execution& execution) {
  std::vector<mesh::Pair> seams;
  if (flat) seams = sorted_pairs(flat->seams);
  std::vector<Piece> parts = cut_apart(part, names, execution);
  std::ranges::stable_sort(parts, [](const Piece& a, const Piece& b) { return a.part->area > b.part->area; });
  std::vector<Piece> found;
  double tubes = 0;
  for (Piece& piece : parts) {
    if (piece.name == flat::kRest || !may_be_smooth(*piece.part, flat != nullptr)) continue;
    if (flat && !is_minded(piece, *flat, seams, kMostSoft * std::sqrt(part.area), execution)) continue;
    tubes += piece.part->area;
    found.push_back(std::move(piece));
  }
  return flat || tubes >= kTubes * part.area ? std::move(found) : std::vector<Piece>();
}

PartPointer closed(const PartPointer& part, Execution& execution) {
  if (part->type.boundary_count <= kEnds) return part;
  auto surface = std::make_shared<const mesh::Surface>(flat::without_windows(*part->surface, execution));
  return part_of(std::move(surface), part->up, part->labels, execution);
}

MapPointer opened(const MapPointer& made, const PartPointer& part, Execution& execution) {
  if (made->part() == part) return made;
  const mesh::Surface& surface = *part->surface;
  auto tiling = std::make_shared<SeamlessMap>(inside(*made->tiling(), surface));
  tiling->uv.conservativeResize(static_cast<Eigen::Index>(surface.polygons.corner_vertices.size()), 2);
  const uv::Quality& before = made->quality();
  tiling->quality = uv::quality(surface, tiling->uv, execution.workers());
  tiling->quality.unseen_angle = before.unseen_angle;
  if (before.direction && part->has_positions())
    tiling->quality.direction =
        uv::direction(surface, tiling->uv, part->up, before.direction->turns, execution.workers());
  tiling->triangulation = part->surface;
  return std::make_shared<const Map>(part, made->structure(), std::move(tiling), execution)->because(made->why());
}

std::vector<mesh::Pair> sorted_pairs(std::vector<mesh::Pair> pairs) {
  for (auto& [a, b] : pairs) {
    if (a > b) std::swap(a, b);
  }
  std::ranges::sort(pairs);
  return pairs;
}

bool holds(const std::vector<mesh::Pair>& pairs, int a, int b) { return mesh::edge_between(pairs, a, b) >= 0; }

}  // namespace holomorph::choice
