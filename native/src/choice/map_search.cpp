#include "choice/map_search.h"
#include "base/constants.h"
#include "base/errors.h"
#include "choice/any_structure.h"
#include "choice/automatic_structure.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

constexpr const char* kTooFew = "too few whole tiles fit on it for squares of the wanted size";
constexpr const char* kShort = "not all was tried, as it would take long";
// Part of the work, where other numbers of tiles follow.
constexpr double kFirst = 0.5;
// Works of the balanced map and of one cut open, over that of a tiling; of pieces over that of islands; and operations
// of the millionth of a second in which that counts.
constexpr double kOfBalanced = 0.2, kOfCut = 1.5, kOfPieces = 1.2, kOperations = 1e3;
// With fewer tiles none has room for cones or poles.
constexpr double kFewestTiles = 1;
// Times the budget, within which pieces follow a tiling: where there are hard edges they are often better.
constexpr double kPieces = 2;
// Operations for each triangle, to find out where few see a cut; and triangles from which on that is no longer quick.
constexpr double kHiding = 1.5e4;
constexpr int kQuickCut = 25'000;
// Millionths of a second for each operation of a tiling that takes long: about a tenth of its time.
constexpr double kIslands = 1e-4;
// Seconds of one processor that all real forms of a part may take, and besides for each of its triangles. Poles and a
// map of so many forms take ten times as long.
constexpr double kMostSeconds = 0.25, kMostPerTriangle = 2e-5;
// Seconds for a value of a form on an edge, for a product of two of these, and for a product in a dense matrix of all.
constexpr double kSolved = 1e-7, kMultiplied = 5e-11, kDense = 2e-9;

// The cost of squares of another size than on other parts: as between those of one part (uv/appearance.h).
double missed(const Map& made, double density, const Window& window) {
  const double size = relative_size(made, density);
  return made.is_tiled() && !window.holds(size) ? std::abs(std::log(size)) : 0;
}

}  // namespace

int form_count(const Part& part) { return part.type.closed() ? part.type.genus : part.type.form_count(); }

bool has_too_many_forms(const Part& part) {
  const double count = 2 * form_count(part), triangles = part.triangle_count(), edges = 1.5 * triangles;
  const double seconds = count * edges * (kSolved + count * kMultiplied) + std::pow(count, 3) * kDense;
  return part.has_positions() && seconds >= kMostSeconds + kMostPerTriangle * triangles;
}

bool is_outline(const Part& part) {
  const bool is_disk = part.type.genus == 0 && part.type.boundary_count == 1;
  return is_disk && part.has_positions() && part.area > 0 && part.triangle_count() == part.surface->vertex_count - 2;
}

MapSearch::MapSearch(Request request, std::shared_ptr<Budget> budget, Execution& execution)
    : request_(std::move(request)),
      budget_(budget ? std::move(budget) : std::make_shared<Budget>(request_.part->triangle_count(), request_.effort)) {
  if (request_.main == Main::kIslands) {
    Untiled untiled(request_.part, nullptr, request_.evenness, request_.is_upright(), execution);
    final_ = untiled.along(request_.cuts, execution);
    return;
  }
  if (!request_.structure && has_too_many_forms(*request_.part)) final_ = islands_instead(execution);
  if (!request_.structure && is_outline(*request_.part)) final_ = flat_outline(execution);
  if (final_) return;
  const Budget::Counting counting(*budget_);
  if (!request_.structure) request_.structure = automatic_structure(request_.part, {}, execution);
  tilings_.emplace(request_.part, request_.structure, request_, *budget_);
  untiled_.emplace(request_.part, request_.structure, request_.evenness, request_.is_upright(), execution);
  final_ = found_at_once(execution);
}

// The islands of a part whose forms would take too long, where these are not asked for.
MapPointer MapSearch::islands_instead(Execution& execution) {
  const bool is_any = request_.main == Main::kAutomatic || request_.main == Main::kUntiled;
  if (!is_any || !request_.tiling.poles.is_open()) return nullptr;
  Untiled untiled(request_.part, nullptr, request_.evenness, request_.is_upright(), execution);
  return untiled.instead(std::to_string(form_count(*request_.part)) + " forms, too many to solve for", execution);
}

// The islands that are taken at once: they need no structure.
MapPointer MapSearch::flat_outline(Execution& execution) const {
  if (request_.main != Main::kAutomatic) return nullptr;
  Untiled untiled(request_.part, nullptr, request_.evenness, request_.is_upright(), execution);
  const MapPointer flat = untiled.at_once(execution);
  return flat && !may_be_better(flat->layout().get()) ? flat : nullptr;
}

// The map where no other is tried.
MapPointer MapSearch::found_at_once(Execution& execution) {
  const Request& asked = request_;
  if (asked.main == Main::kBalanced) {
    const bool is_upright = asked.is_upright() && asked.structure->form_count() == 0;
    return form_map(asked.part, asked.structure, asked.evenness, is_upright, "it was asked for", execution);
  }
  if (asked.main == Main::kUntiled) return held(untiled_).best("it has no tiling", execution);
  if (asked.main == Main::kSeamless) return nullptr;
  if (asked.part->area == 0)
    return form_map(asked.part, asked.structure, asked.evenness, false, "the surface has no area", execution);
  flat_ = held(untiled_).at_once(execution);
  return flat_ && !may_be_better(flat_->layout().get()) ? flat_ : nullptr;
}

std::vector<MapPointer> MapSearch::maps(double density, int tries, bool leads, Execution& execution) {
  if (final_) return {final_};
  const Budget::Counting counting(*budget_);
  return tried(density, tries, leads, execution);
}

std::vector<MapPointer> MapSearch::tried(double density, int tries, bool leads, Execution& execution) {
  TilingSearch& tilings = held(tilings_);
  if (request_.main == Main::kSeamless) return tilings.of_density(density, tries, execution);
  if (is_in_pieces_) {  // with another density they keep their kinds
    if (const MapPointer same = held(pieces_).resized(density, execution)) return {said(same)};
  }
  const MapPointer best = nested(execution, 0.0, tries > 1 ? kFirst : 1.0,
                                 [&] { return least(candidates(density, tries, leads), flat_, *budget_, execution); });
  if (!best) return {said(held(untiled_).best(why_untiled(), execution))};
  std::vector<MapPointer> result{best};
  is_in_pieces_ = best->is_in_pieces();
  if (best->tiling()) {
    result = nested(execution, kFirst, 1.0, [&] { return tilings.resized(best, density, tries, execution); });
  }
  for (MapPointer& made : result) made = said(made);
  return result;
}

// All maps of the part: islands and pieces first where it is not smooth, nor a ring; tilings, and cut open where one is
// uneven; islands where these are poor; and the balanced map.
std::vector<Candidate> MapSearch::candidates(double density, int tries, bool leads) {
  Untiled& untiled = held(untiled_);
  TilingSearch& tilings = held(tilings_);
  const double work = tilings.expected_work(), little = kOperations * untiled.work();
  const bool is_long = !budget_->allows(work), is_flat = is_long || (!is_ring() && untiled.may_flatten());
  const auto any = [](const MapPointer&, Execution&) { return 0.0; };
  const auto poor = [](const MapPointer& best, Execution&) { return best && best->cost() < kPoor ? kInfinity : 0.0; };
  const auto islands = [&untiled](double most_work) {
    return [&untiled, most_work](const MapPointer& best, Execution& execution) {
      return untiled.islands(best ? best->cost() : kInfinity, most_work, execution);
    };
  };
  const auto pieces = [=, this](bool is_cut) {
    return [=, this](const MapPointer& best, Execution& execution) {
      return in_pieces(best, is_cut, density, leads ? tries : 0, execution);
    };
  };
  const auto balanced = [this, &untiled](const MapPointer&, Execution& execution) {
    return untiled.balanced(why_untiled(), execution);
  };
  std::vector<Candidate> result, whole;
  const Candidate in_pieces{kOfPieces * little, any, pieces(false), kPieces, true};
  const bool is_good = flat_ && flat_->cost() <= kGood;
  const double flat_work = is_long ? std::max(untiled.work(), work * kIslands) : untiled.work();
  if (is_flat && !is_good) result.push_back({little, any, islands(flat_work), kFar});
  if (is_flat) result.push_back(in_pieces);
  const double tiles = density * request_.part->area;
  const bool has_room = tiles >= kFewestTiles || is_ring() || tilings.is_strict();
  if (has_room && (!is_good || is_ring())) {
    whole = tilings.candidates(tiles, tries > 1);
    // Poles come last, and turn more rows than a cut is seen, but on a ring, which may need none.
    const int count = request_.part->triangle_count();
    whole.insert(whole.end() - (is_ring() ? 0 : 1),
                 {kOfCut * work + kHiding * count, any, pieces(true), count <= kQuickCut ? kPieces : 1});
  }
  std::ranges::move(whole, std::back_inserter(result));
  result.push_back({little, poor, islands(untiled.much_work()), kFar});
  if (!is_flat) result.push_back(in_pieces);
  result.push_back({kOfBalanced * work, poor, balanced});
  return result;
}

std::string MapSearch::why_untiled() const {
  const std::exception_ptr& refused = held(tilings_).refused();
  try {
    if (refused) std::rethrow_exception(refused);
  } catch (const Error& error) {
    return std::string("no tiling can be made: ") + error.what();
  }
  return "a tiling would look worse";
}

// The map, which says where others were not tried.
MapPointer MapSearch::said(const MapPointer& made) const {
  return budget_->was_short() ? made->because(made->why() + "; " + kShort) : made;
}

MapPointer MapSearch::fitted(const std::vector<MapPointer>& found, double density, const Window& window, double near,
                             Execution& execution) {
  const Budget::Counting counting(*budget_);
  std::vector<MapPointer> inside;
  for (const MapPointer& made : found) {
    if (window.holds(relative_size(*made, density))) inside.push_back(made);
  }
  const bool is_inside = !inside.empty();
  const MapPointer made = nearest(is_inside ? inside : found, density);
  if (made->is_in_pieces() && !is_inside) {
    const MapPointer exact = held(pieces_).resized(density, execution);
    return exact ? exact : made;
  }
  if (!made->tiling()) return made;
  if (is_inside || held(tilings_).is_strict()) {
    const MapPointer moved = held(tilings_).moved(is_inside ? inside : found, density, true, execution);
    if (is_inside) return moved;
    const MapPointer stretched = held(tilings_).stretched(*moved, density, execution);
    return stretched ? stretched : moved;
  }
  return best_of_others(made, found, density, window, near, execution);
}

MapPointer MapSearch::best_of_others(const MapPointer& made, const std::vector<MapPointer>& found, double density,
                                     const Window& window, double near, Execution& execution) {
  std::vector<MapPointer> others;
  if (made->turns() != 1) {
    others = {less_bound(made, density, window, near, execution)};
  } else if (const MapPointer fitting = stretched_or_turned(made, density, window, execution)) {
    return request_.main == Main::kSeamless ? fitting : cheaper(fitting, held(untiled_).best(kTooFew, execution));
  } else {
    others = {held(untiled_).best(kTooFew, execution), held(untiled_).one_island(*made->tiling(), kTooFew, execution)};
  }
  for (const MapPointer& one : found) {
    if (std::abs(relative_size(*one, density) - 1) <= near) others.push_back(one);
  }
  std::erase(others, nullptr);
  const auto cost = [&](const MapPointer& one) { return one->cost() + missed(*one, density, window); };
  return held(std::ranges::min_element(others, {}, cost), others);
}

MapPointer MapSearch::instead_of_refused(const std::string& why, Execution& execution) {
  const Budget::Counting counting(*budget_);
  return held(untiled_).best(why, execution);
}

// As `fitted`, of maps without lines, or of those that do not turn: these have more sizes.
MapPointer MapSearch::less_bound(const MapPointer& made, double density, const Window& window, double near,
                                 Execution& execution) {
  Request request = request_;
  if (made->tiling()->rows != tiling::Rows::kNone) {
    request.rows = tiling::Rows::kNone;
  } else {
    request.tiling.lattice = made->tiling()->lattice;
    request.tiling.turns = 1;
  }
  MapSearch search(std::move(request), budget_, execution);
  const auto maps = nested(execution, 0.0, 0.5, [&] { return search.maps(density, kTries, false, execution); });
  return nested(execution, 0.5, 1.0, [&] { return search.fitted(maps, density, window, near, execution); });
}

MapPointer MapSearch::about(double density, int tries, Execution& execution) {
  const std::vector<MapPointer> found = maps(density, tries, true, execution);
  return found[0]->tiling() ? held(tilings_).moved(found, density, tries > 1, execution) : found[0];
}

// The tiling stretched to the density, or turned until it is in the window; null where it is neither.
MapPointer MapSearch::stretched_or_turned(const MapPointer& made, double density, const Window& window,
                                          Execution& execution) {
  if (const MapPointer stretched = held(tilings_).stretched(*made, density, execution)) return stretched;
  const MapPointer turned = held(tilings_).less_level(*made, density, execution);
  return turned && window.holds(relative_size(*turned, density)) ? turned : nullptr;
}

MapPointer MapSearch::in_pieces(const MapPointer& rival, bool is_cut, double density, int tries, Execution& execution) {
  if (held(tilings_).is_strict() || !may_be_better(held(untiled_).known().get())) return nullptr;
  if (!pieces_) pieces_.emplace(request_, request_.structure, held(untiled_).known(), *budget_);
  return is_cut ? pieces_->cut_open(rival, density, tries, execution) : pieces_->best(rival, density, tries, execution);
}

// Whether islands have a seam across the smooth, or squares that differ, or there are none.
bool MapSearch::may_be_better(const flat::Layout* flat) const {
  if (!request_.part->has_positions()) return false;
  return !flat || flat->soft_length > kMostSoft || uv::cost_of_squares(flat->quality) > kFlat;
}

// Whether it may need no poles.
bool MapSearch::is_ring() const {
  const mesh::TopologicalType& type = request_.part->type;
  return request_.part->is_tube() || (type.genus == 1 && type.closed());
}

}  // namespace holomorph::choice
