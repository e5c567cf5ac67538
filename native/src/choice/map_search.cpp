#include "choice/map_search.h"
#include "base/constants.h"
#include "base/errors.h"
#include "choice/any_structure.h"
#include "choice/automatic_structure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

constexpr const char* kTooFew = "too few whole tiles fit on it for squares of the wanted size";
constexpr const char* kShort = "not all was tried, as it would take long";
// Part of the work, where pieces follow.
constexpr double kTiling = 0.8;
// Times the budget, within which pieces follow a tiling: where there are hard edges they are often better.
constexpr double kPieces = 2;
// Millionths of a second for each operation of a tiling that takes long: about a tenth of its time.
constexpr double kIslands = 1e-4;
// Times the budget: what takes longer is not tried where there is another map, however poor.
constexpr double kFar = 10;

// Seconds of one processor that all real forms of a part may take, and besides for each of its triangles. Poles and a
// map of so many forms take ten times as long.
constexpr double kMostSeconds = 0.25, kMostPerTriangle = 2e-5;
// Seconds for a value of a form on an edge, for a product of two of these, and for a product in a dense matrix of all.
constexpr double kSolved = 3e-8, kMultiplied = 5e-11, kDense = 2e-9;

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
  MapPointer best = flat_;
  std::vector<MapPointer> tilings;
  const bool is_long = this->is_long();
  if (is_long) {
    if (const MapPointer made = quick(density, leads ? tries : 0, execution)) best = made;
    const double times = best && best->cost() >= kPoor ? kFar : 1;
    if (best && !budget_->goes_on(held(tilings_).expected_work(), times)) return {said(best)};
  }
  if (!best || is_ring() || best->cost() > kGood) {
    std::string why = "a tiling would look worse";
    const auto whole = [&] {
      return nested(execution, 0.0, kTiling, [&] { return held(tilings_).of_density(density, tries, execution); });
    };
    if (request_.main == Main::kSeamless) return whole();
    tilings = unless_refused(whole, [&](const Error& error) {
      why = std::string("no tiling can be made: ") + error.what();
      return std::vector<MapPointer>();
    });
    execution.part(kTiling, kTiling);
    best = least(best, tilings.empty() ? nullptr : nearest(tilings, density), why, execution);
  }
  if (!is_long) {  // else they were tried
    const MapPointer pieces = nested(execution, kTiling, 1.0, [&] {
      return in_pieces(best, density, leads ? tries : 0, window_around(), execution);
    });
    if (pieces) best = pieces;
  }
  std::vector<MapPointer> result =
      std::ranges::find(tilings, best) != tilings.end() ? std::move(tilings) : std::vector{best};
  for (MapPointer& made : result) made = said(made);
  return result;
}

// Whether a tiling of the whole part, that may be left out, takes more than there is.
bool MapSearch::is_long() const {
  const bool is_open = request_.main != Main::kSeamless && !held(tilings_).is_strict();
  return is_open && !budget_->allows(held(tilings_).expected_work());
}

// The best of the maps that take less than a tiling of the whole part.
MapPointer MapSearch::quick(double density, int tries, Execution& execution) {
  const MapPointer islands = held(untiled_).islands(kInfinity, held(tilings_).expected_work() * kIslands, execution);
  const MapPointer best = flat_ && islands ? (islands->cost() < flat_->cost() ? islands : flat_)
                          : flat_          ? flat_
                                           : islands;
  const MapPointer pieces = in_pieces(best, density, tries, window_around(), execution);
  return pieces ? pieces : best;
}

// The map, which says where others were not tried.
MapPointer MapSearch::said(const MapPointer& made) const {
  return budget_->was_short() ? made->because(made->why() + "; " + kShort) : made;
}

// The one of least cost among these and the other maps of the whole part.
MapPointer MapSearch::least(const MapPointer& flat, const MapPointer& tiling, const std::string& why,
                            Execution& execution) {
  MapPointer best = flat && tiling ? (tiling->cost() < flat->cost() ? tiling : flat) : flat ? flat : tiling;
  const bool is_poor = !best || best->cost() >= kPoor;
  if (best && !budget_->goes_on(0, is_poor ? kFar : 1)) return best;
  if (const MapPointer balanced = held(untiled_).balanced(best ? best->cost() : kInfinity, why, execution))
    best = balanced;
  if (!best) return held(untiled_).best(why, execution);
  if (flat && flat->cost() <= kGood) return best;
  const MapPointer islands =
      held(untiled_).islands(best->cost(), is_poor ? std::optional(kInfinity) : std::nullopt, execution);
  return islands ? islands : best;
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
    const MapPointer exact = in_pieces(nullptr, density, 0, Window(), execution);
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
    return fitting;
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
  const MapPointer stretched = held(tilings_).stretched(*made, density, execution);
  if (stretched && !has_rival(*stretched, execution)) return stretched;
  const MapPointer turned = held(tilings_).turned(density, execution);
  return turned && window.holds(relative_size(*turned, density)) ? turned : nullptr;
}

bool MapSearch::has_rival(const Map& made, Execution& execution) {
  if (request_.main == Main::kSeamless || !budget_->goes_on()) return false;
  return held(untiled_).balanced(made.cost(), "", execution) || held(untiled_).islands(made.cost(), {}, execution);
}

MapPointer MapSearch::in_pieces(const MapPointer& rival, double density, int tries, const Window& window,
                                Execution& execution) {
  if (held(tilings_).is_strict() || !may_be_better(held(untiled_).known().get())) return nullptr;
  if (rival && rival->tiling() && !budget_->goes_on(0, kPieces)) return nullptr;
  if (!pieces_) pieces_.emplace(request_, request_.structure, held(untiled_).known(), *budget_);
  return pieces_->best(rival, density, tries, window, execution);
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
