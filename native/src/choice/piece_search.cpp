#include "choice/piece_search.h"
#include "base/constants.h"
#include "choice/automatic_structure.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "choice/map.h"
#include "choice/untiled.h"
#include "flat/arrangement.h"
#include "flat/island_search.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

// The map of a part in pieces, from the maps of these.

// A piece with its map, whose elements are those of the piece.
struct MappedPiece {
  const Piece* piece = nullptr;
  MapPointer map;
};

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

Seams seams_of(const mesh::Surface& surface, const std::vector<MappedPiece>& pieces) {
  std::vector<mesh::Pair> borders, whole;  // where it breaks off, and where it jumps by whole tiles
  for (const auto& [piece, map] : pieces) {
    const auto add = [&index = piece->vertex_index](std::vector<mesh::Pair>& pairs, const mesh::Pair& ends) {
      pairs.push_back({index[ends[0]], index[ends[1]]});
    };
    const mesh::Surface& own = *map->part()->surface;
    for (std::size_t e = 0; e < own.edges.size(); ++e) {
      if (own.edge_face_count[e] == 1) add(borders, own.edges[e]);
    }
    for (const mesh::Pair& ends : map->seams()) add(map->tiling() ? whole : borders, ends);
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

std::string why(const uv::Quality& quality, std::size_t tiled, std::size_t pieces, bool is_cut) {
  const std::string range = ": size range " + size_range(quality);
  if (is_cut) return "cut open where it is hardly seen it has whole tiles" + range;
  const std::string has =
      tiled == 1 ? "1 piece between hard edges has" : std::to_string(tiled) + " pieces between hard edges have";
  return has + " whole tiles" + (tiled < pieces ? ", the rest flattens" : "") + range;
}

// The map of a part from those of its pieces, of which one at least is a tiling.
// @param cut how far the seams are seen, over the square root of the area; none along hard edges
MapPointer mixed_map(const PartPointer& part, const StructurePointer& structure, const std::vector<MappedPiece>& pieces,
                     double evenness, const std::optional<double>& cut, Execution& execution) {
  const std::vector<flat::Laid> maps = laid(pieces);
  const double unit = flat::unit_length(maps, {}, execution.workers());
  auto made = std::make_shared<flat::Layout>();
  std::vector<SeamlessPointer> tilings;
  made->uv =
      flat::arranged(maps, static_cast<int>(part->surface->polygons.corner_vertices.size()), {}, execution.workers());
  made->quality = joined_quality(pieces, unit, execution.workers());
  for (const auto& [piece, map] : pieces) {
    if (map->tiling()) tilings.push_back(of_part(*map->tiling(), piece->vertex_index));
  }
  Seams seams = seams_of(*part->surface, pieces);
  made->seams = std::move(seams.edges);
  made->evenness = evenness;
  std::tie(made->soft_length, made->hard_length) = seen_lengths(*part, seams.is_border, cut);
  std::string reason = why(made->quality, tilings.size(), pieces.size(), cut.has_value());
  return std::make_shared<const Map>(part, structure, std::move(made), std::move(reason), execution,
                                     std::move(tilings));
}

constexpr double kUneven = 2.2;  // density ratio of a tiling, from which on it may be better to cut the part open

// The edges of a piece that are marked on the part, by their vertices on the piece.
std::vector<mesh::Pair> marked_on(const Piece& piece, const mesh::Surface& surface, std::vector<mesh::Pair> marked) {
  if (marked.empty()) return marked;
  marked = sorted_pairs(std::move(marked));
  std::vector<mesh::Pair> result;
  for (const mesh::Pair& ends : surface.edges) {
    if (holds(marked, piece.vertex_index[ends[0]], piece.vertex_index[ends[1]])) result.push_back(ends);
  }
  return result;
}

}  // namespace

PieceSearch::PieceSearch(Request request, StructurePointer structure, LayoutPointer flat, Budget& budget)
    : request_(std::move(request)), structure_(std::move(structure)), flat_(std::move(flat)), budget_(budget) {}

MapPointer PieceSearch::best(const MapPointer& rival, double density, int tries, Execution& execution) {
  if (!found_) found_ = nested(execution, 0.0, 0.0, [&] { return divisions(execution); });
  return best(*found_, rival, density, tries, window_around(), execution);
}

MapPointer PieceSearch::cut_open(const MapPointer& rival, double density, int tries, Execution& execution) {
  if (!may_be_cut(rival)) return nullptr;
  if (!cut_) cut_ = nested(execution, 0.0, 0.0, [&] { return in_hiding(execution); });
  return best(*cut_, rival, density, tries, window_around(), execution);
}

MapPointer PieceSearch::resized(double density, Execution& execution) {
  return last_ ? best(*last_, nullptr, density, 0, Window(), execution) : nullptr;
}

MapPointer PieceSearch::best(std::vector<Division>& all, const MapPointer& rival, double density, int tries,
                             const Window& window, Execution& execution) {
  MapPointer best;
  double least = kInfinity;
  const auto count = static_cast<double>(all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    const double begin = static_cast<double>(n) / count, end = static_cast<double>(n + 1) / count;
    const std::vector<Tiled> tiled =
        nested(execution, begin, end, [&] { return this->tiled(all[n], rival, density, tries, window, execution); });
    const double most = rival ? rival->cost() + (rival->is_in_islands() ? cost_of_turns(tiled) : 0) : kInfinity;
    const Minded made = nested(execution, end, end, [&] { return least_minded(all[n], tiled, execution); });
    if (made.map && made.cost < std::min(most, least)) {
      best = made.map;
      least = made.cost;
      last_ = &all;
    }
    if (made.map && made.map->cost() - uv::kHardSeam * made.map->layout()->hard_length <= kFlat) break;
    if (best && n + 1 < all.size() && !budget_.goes_on()) break;
  }
  return best;
}

// By each angle that divides the part in another way.
std::vector<PieceSearch::Division> PieceSearch::divisions(Execution& execution) {
  const mesh::Surface& surface = *request_.part->surface;
  const std::vector<double> bent = mesh::breaks(surface);
  std::vector<Division> result;
  std::vector<int> known;
  for (const double degrees : flat::kHardAngles) {
    if (degrees <= flat::kSmoothAngle) continue;
    std::vector<char> is_hard(bent.size());
    std::ranges::transform(bent, is_hard.begin(), [&](double own) { return own > mesh::radians(degrees); });
    std::vector<int> names = flat::names_of_pieces(surface, is_hard);
    if (std::ranges::count(names, names.front()) == std::ssize(names) || names == known) continue;
    known = names;
    Division division{std::move(names), {}, {}};
    for (Piece& piece : smooth_pieces(*request_.part, flat_.get(), known, execution)) {
      if (auto search = search_of(piece, false, execution)) division.pieces.push_back({std::move(piece), *search});
    }
    if (!division.pieces.empty()) result.push_back(std::move(division));
  }
  return result;
}

// Whether squares differ so much that another tiling is made of the part cut open. Only those that turn gain by that:
// others had more poles on it.
bool PieceSearch::may_be_cut(const MapPointer& rival) const {
  const bool is_uneven = rival && rival->tiling() && rival->quality().density_ratio > kUneven;
  return is_uneven && request_.main == Main::kAutomatic && request_.tiling.turns != 1;
}

// The part cut open; none if it falls apart or cannot be solved.
std::vector<PieceSearch::Division> PieceSearch::in_hiding(Execution& execution) {
  const bool is_upright = request_.is_upright();
  auto found =
      structure_->pieces().cut.get(is_upright, [&] { return cut_in_hiding(*request_.part, is_upright, execution); });
  if (!found) return {};
  auto& [piece, seen] = *found;
  const auto search = search_of(piece, true, execution);
  if (!search) return {};
  std::vector<Division> result(1);
  result[0].names.assign(request_.part->surface->polygons.face_offsets.size() - 1, 0);
  result[0].cut = seen;
  result[0].pieces.push_back({std::move(piece), *search});
  return result;
}

// None for a piece on which nothing can be solved: it becomes an island.
std::optional<TilingSearch> PieceSearch::search_of(Piece& piece, bool is_cut, Execution& execution) {
  return unless_refused(
      [&] {
        std::vector<int> key = piece.face_index;
        if (is_cut) key.push_back(request_.is_upright() ? -2 : -1);  // another cut through the same polygons
        const auto [own, structure] = structure_->pieces().solved.get(key, [&] {
          const PartPointer part = is_cut ? piece.part : closed(piece.part, execution);
          return std::pair(piece.part, automatic_structure(part, {}, execution));
        });
        piece.part = own;
        const PartPointer& part = structure->part();
        Request request = request_;
        if (is_cut) request.rows = tiling::Rows::kNone, request.tiling.poles.count = 0;
        request.tiling.marked = marked_on(piece, *part->surface, std::move(request.tiling.marked));
        return std::optional<TilingSearch>(std::in_place, part, structure, std::move(request), budget_);
      },
      [](const Error&) { return std::nullopt; });
}

// Whether the tiling of a piece may be part of a map that costs less than the rival, and than the piece's islands: on a
// tube these may turn rows that could run around it.
bool PieceSearch::is_worth(Solved& solved, const Division& division, const MapPointer& rival, double density,
                           Execution& execution) const {
  const Part& piece = *solved.piece.part;
  const double bound = solved.search.bound(density * piece.area, execution);
  if (!solved.search.part()->is_tube() && bound >= solved.piece.cost) return false;
  const double seam = uv::kSeam * division.cut.value_or(0);
  return !rival || !rival->tiling() || (bound + seam) * piece.area < rival->cost() * request_.part->area;
}

// The pieces with tilings that may be better than islands.
std::vector<PieceSearch::Tiled> PieceSearch::tiled(Division& division, const MapPointer& rival, double density,
                                                   int tries, const Window& window, Execution& execution) {
  std::vector<Solved*> pieces;
  for (Solved& each : division.pieces) {
    if (nested(execution, 0.0, 0.0, [&] { return is_worth(each, division, rival, density, execution); }))
      pieces.push_back(&each);
  }
  std::vector<Tiled> made;
  const auto count = static_cast<double>(pieces.size());
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const bool leads = tries > 0 && made.empty();
    auto& [piece, search] = *pieces[n];
    const MapPointer tiling = nested(execution, static_cast<double>(n) / count, static_cast<double>(n + 1) / count,
                                     [&] { return of_density(search, density, leads ? tries : 0, window, execution); });
    if (!tiling) continue;
    Tiled one{&piece, opened(tiling, piece.part, execution)};
    // Poles turn rows, too.
    if (search.part()->is_tube() && one.map->pole_count() == 0)
      one.turn = uv::kTurn * turn_against(piece, one.map->uv());
    if (!(one.map->cost() < piece.cost + one.turn)) continue;
    if (leads) density = one.map->density();
    made.push_back(std::move(one));
  }
  return made;
}

// A tiling with any density, by some tries, or with one in the window, if need be stretched; null without.
MapPointer PieceSearch::of_density(TilingSearch& search, double density, int tries, const Window& window,
                                   Execution& execution) {
  const int most = tries > 0 ? tries : search.part()->is_tube() ? 1 : kTries;
  const std::vector<MapPointer> tilings = unless_refused([&] { return search.of_density(density, most, execution); },
                                                         [](const Error&) { return std::vector<MapPointer>(); });
  if (tilings.empty()) return nullptr;
  MapPointer made = nearest(tilings, density);
  if (tries > 0 || window.holds(relative_size(*made, density))) return made;
  if (MapPointer stretched = search.stretched(*made, density, execution)) return stretched;
  return window_around().holds(relative_size(*made, density)) ? made : nullptr;
}

// The map in pieces, null without, and its cost with that of rows that turn in its islands: with all tilings, or with
// those alone that cost less than islands.
PieceSearch::Minded PieceSearch::least_minded(const Division& division, const std::vector<Tiled>& tiled,
                                              Execution& execution) {
  std::vector<Tiled> cheaper, dearer;
  for (const Tiled& one : tiled) (one.map->cost() < one.piece->cost ? cheaper : dearer).push_back(one);
  Minded best = {glued(division, tiled, execution), kInfinity};
  if (best.map) best.cost = best.map->cost();
  if (dearer.empty()) return best;
  if (const MapPointer other = glued(division, cheaper, execution)) {
    const double cost = other->cost() + cost_of_turns(dearer);
    if (cost < best.cost) best = {other, cost};
  }
  return best;
}

// The map with these tilings; null without any, and where the rest has none.
MapPointer PieceSearch::glued(const Division& division, const std::vector<Tiled>& tiled, Execution& execution) {
  if (tiled.empty()) return nullptr;
  std::vector<int> names(division.names.size(), flat::kRest);
  for (std::size_t f = 0; f < names.size(); ++f) {
    const int name = division.names[f];
    if (std::ranges::any_of(tiled, [&](const Tiled& one) { return one.piece->name == name; })) names[f] = name;
  }
  std::vector<Piece> parts;
  std::vector<MappedPiece> maps;
  for (const Tiled& one : tiled) maps.push_back({one.piece, one.map});
  const bool is_whole = unless_refused(
      [&] {
        parts = cut_apart(*request_.part, names, execution);
        for (const Piece& each : parts) {
          if (each.name == flat::kRest)
            maps.push_back({&each, flat_ ? as_islands(each, execution) : untiled(each, execution)});
        }
        return true;
      },
      [](const Error&) { return false; });
  if (!is_whole) return nullptr;
  return mixed_map(request_.part, structure_, maps, request_.evenness, division.cut, execution);
}

// The islands of the part on a piece without tiling.
MapPointer PieceSearch::as_islands(const Piece& piece, Execution& execution) const {
  const mesh::Surface& surface = *piece.part->surface;
  auto made = std::make_shared<flat::Layout>();
  made->uv.resize(static_cast<Eigen::Index>(piece.corner_index.size()), 2);
  for (std::size_t c = 0; c < piece.corner_index.size(); ++c)
    made->uv.row(static_cast<Eigen::Index>(c)) = flat_->uv.row(piece.corner_index[c]);
  made->quality = uv::quality(surface, made->uv, execution.workers());
  if (flat_->quality.direction)
    made->quality.direction = uv::direction(surface, made->uv, piece.part->up, 1, execution.workers());
  const std::vector<mesh::Pair> seams = sorted_pairs(flat_->seams);
  for (const mesh::Pair& ends : surface.edges) {
    if (holds(seams, piece.vertex_index[ends[0]], piece.vertex_index[ends[1]])) made->seams.push_back(ends);
  }
  made->evenness = flat_->evenness;
  made->islands = 1;
  return std::make_shared<const Map>(piece.part, nullptr, std::move(made), "", execution);
}

// The map of a piece without tiling, where the part has no islands. Several divisions have the same pieces.
MapPointer PieceSearch::untiled(const Piece& piece, Execution& execution) {
  MapPointer& known = rest_[piece.face_index];
  if (!known) {
    Untiled search(piece.part, nullptr, request_.evenness, request_.is_upright(), execution);
    known = search.best("it has no tiling", execution);
  }
  return known;
}

// The cost of rows that turn, for the whole part, if these pieces are islands.
double PieceSearch::cost_of_turns(const std::vector<Tiled>& tiled) const {
  double sum = 0;
  for (const Tiled& one : tiled) sum += one.turn * one.piece->part->area;
  return sum / request_.part->area;
}

}  // namespace holomorph::choice
