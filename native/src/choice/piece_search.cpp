#include "choice/piece_search.h"
#include "choice/automatic_structure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "choice/untiled.h"
#include "flat/island_search.h"
#include "mesh/facets.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
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

PieceSearch::PieceSearch(Request request, StructurePointer structure, std::shared_ptr<const flat::Islands> flat,
                         Budget& budget)
    : request_(std::move(request)), structure_(std::move(structure)), flat_(std::move(flat)), budget_(budget) {}

MapPointer PieceSearch::best(const MapPointer& rival, double density, int tries, const Window& window,
                             Execution& execution) {
  if (!found_) found_ = nested(execution, 0.0, 0.0, [&] { return divisions(execution); });
  if (!cut_ && may_be_cut(rival)) cut_ = nested(execution, 0.0, 0.0, [&] { return in_hiding(execution); });
  std::vector<Division*> all;
  for (auto* divisions : {&found_, &cut_}) {
    if (!*divisions) continue;
    for (Division& each : **divisions) all.push_back(&each);
  }
  MapPointer best;
  double least = kInfinity;
  const auto count = static_cast<double>(all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    const double begin = static_cast<double>(n) / count, end = static_cast<double>(n + 1) / count;
    const std::vector<Tiled> tiled =
        nested(execution, begin, end, [&] { return this->tiled(*all[n], rival, density, tries, window, execution); });
    const double most = rival ? rival->cost() + (rival->islands() ? cost_of_turns(tiled) : 0) : kInfinity;
    const Minded made = nested(execution, end, end, [&] { return least_minded(*all[n], tiled, execution); });
    if (made.map && made.cost < std::min(most, least)) {
      best = made.map;
      least = made.cost;
    }
    if (made.map && made.map->cost() - uv::kHardSeam * made.map->mixed()->hard_length <= kFlat) break;
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
  auto found = cut_in_hiding(*request_.part, request_.is_upright(), execution);
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
std::optional<TilingSearch> PieceSearch::search_of(const Piece& piece, bool is_cut, Execution& execution) {
  return unless_refused(
      [&] {
        const PartPointer part = is_cut ? piece.part : closed(piece.part, execution);
        Request request = request_;
        if (is_cut) request.rows = tiling::Rows::kNone;
        request.tiling.marked = marked_on(piece, *part->surface, std::move(request.tiling.marked));
        return std::optional<TilingSearch>(std::in_place, part, automatic_structure(part, {}, execution),
                                           std::move(request), budget_);
      },
      [](const Error&) { return std::nullopt; });
}

// Whether the tiling of a piece may be part of a map that costs less than a tiling of the whole part. On a tube one
// without poles tells that: they would turn the rows that run around it.
bool PieceSearch::is_worth(Solved& solved, const MapPointer& rival, Execution& execution) const {
  if (!rival || !rival->tiling() || !solved.search.part()->is_tube()) return true;
  const double guess = solved.search.guess_without_poles(execution);
  return guess * solved.piece.part->area < rival->cost() * request_.part->area;
}

// The pieces with tilings that may be better than islands.
std::vector<PieceSearch::Tiled> PieceSearch::tiled(Division& division, const MapPointer& rival, double density,
                                                   int tries, const Window& window, Execution& execution) {
  std::vector<Solved*> pieces;
  for (Solved& each : division.pieces) {
    if (nested(execution, 0.0, 0.0, [&] { return is_worth(each, rival, execution); })) pieces.push_back(&each);
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
    if (search.part()->is_tube() && one.map->pole_count() == 0) one.turn = uv::kTurn * piece.turn(one.map->uv());
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
          if (each.name == flat::kRest) maps.push_back({&each, untiled(each, execution)});
        }
        return true;
      },
      [](const Error&) { return false; });
  if (!is_whole) return nullptr;
  return mixed_map(request_.part, structure_, maps, request_.evenness, division.cut, execution);
}

// The map of a piece without tiling. Several divisions have the same pieces.
MapPointer PieceSearch::untiled(const Piece& piece, Execution& execution) {
  MapPointer& known = rest_[piece.face_index];
  if (!known) {
    const StructurePointer structure = automatic_structure(piece.part, {}, execution);
    Untiled search(piece.part, structure, request_.evenness, request_.is_upright(), execution);
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
