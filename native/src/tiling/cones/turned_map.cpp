#include "tiling/cones/turned_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "base/execution.h"
#include "tiling/cones/carried_map.h"
#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"
#include "tiling/cones/upright.h"
#include "uv/appearance.h"
#include "uv/evening.h"

namespace holomorph::tiling {
namespace {

// Cones that are chosen, and what is then missing of the holes.

constexpr double kCheaper = 1e-9;  // of the cost: less is rounding

// The chosen cones, and k-th turns at the holes with which the integral of u^2 is least, see scale_form.h: together
// they are k times the Euler characteristic of the surface with its holes filled.
// @param chosen #V, k-th turns that are missing, none on the boundary
// @return #V as in Cones. @throws TopologyError for other sums on a surface without holes, SolverError, Cancelled
std::vector<int> with_holes(const Net& net, int k, const std::vector<int>& chosen, Execution& execution) {
  std::vector<int> missing = chosen, places;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (chosen[v] != 0 || net.hole[v] == v) places.push_back(v);
  }
  double defect = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] >= 0) defect += net.defect[v];
  }
  const int whole = static_cast<int>(std::lround(defect / (kTwoPi / k)));
  const int left = whole - std::accumulate(chosen.begin(), chosen.end(), 0);
  std::vector<Eigen::Index> holes;
  Eigen::VectorXd n(std::ssize(places));
  for (Eigen::Index i = 0; i < n.size(); ++i) {
    n[i] = chosen[places[i]];
    if (net.hole[places[i]] == places[i]) holes.push_back(i);
  }
  if (left != 0 && holes.empty()) {
    throw TopologyError("around the cones that are chosen " + std::to_string(whole - left) + "/" + std::to_string(k) +
                        " of a turn are missing in all; on this surface it must be " + std::to_string(whole) + "/" +
                        std::to_string(k));
  }
  if (holes.empty()) return missing;
  n[holes[0]] = left;
  ScaleForm form(net, k);
  form.take(places, [&] { execution.report(0); });
  for (bool gains = true; gains;) {
    const Eigen::VectorXd slope = form.Q() * n - form.b();
    double gained = kCheaper;
    Eigen::Index to = 0, from = 0;
    for (const Eigen::Index i : holes) {
      for (const Eigen::Index j : holes) {
        const double gain = 2 * (slope[j] - slope[i]) - form.Q()(i, i) - form.Q()(j, j) + 2 * form.Q()(i, j);
        if (i != j && gain > gained) gained = gain, to = i, from = j;
      }
    }
    gains = to != from;
    if (gains) n[to] += 1, n[from] -= 1;
  }
  for (const Eigen::Index i : holes) missing[places[i]] = static_cast<int>(n[i]);
  return missing;
}

constexpr int kTries = 2, kLinedTries = 4;  // of the nearest whole numbers
constexpr int kMostLevels = 4;              // of half the tiles each, for which cones are searched
constexpr int kFurtherApart = 2;            // levels, where triangles are flipped
constexpr double kHelps = 0.5;              // of the wrong area: else no more is tried

// Steps of evening on all triangles, once the level's map is carried there: what is left is near by. On many triangles
// each step is light, as what it is preconditioned by would take longer than all else.
constexpr int kLightTriangles = 60'000;
const uv::EveningOptions kFine{.steps = 4}, kLight{uv::kDiagonal, 16};
// What tells which start is best: there is no use in turning triangles of few back.
const uv::EveningOptions kDraft{.turning = 0};

// Cones of a level on another one, or on the surface itself. @param vertex of the level: there
std::vector<int> moved(const mesh::Surface& surface, const std::vector<int>& vertex, const std::vector<int>& cones) {
  const Net net(surface);
  std::vector<int> missing(surface.vertex_count, 0);
  for (std::size_t v = 0; v < cones.size(); ++v) {
    if (cones[v] != 0) missing[place_of(net, vertex[v])] += cones[v];
  }
  return missing;
}

// What evening keeps of a map that was carried. Without cones one vertex stays, as the whole map may be moved.
uv::Kept kept_of(const mesh::Surface& surface, const TurnLattice& lattice, const LatticeMap& map) {
  uv::Kept kept;
  kept.turns.resize(surface.triangles.size());
  for (std::size_t side = 0; side < map.at.size(); ++side)
    kept.turns[side / 3][side % 3] = turned_by(lattice, map.at[side].turn);
  kept.unknowns.number.assign(2 * static_cast<std::size_t>(surface.vertex_count), -1);
  kept.unknowns.sign.assign(kept.unknowns.number.size(), 1);
  std::vector<char> stays(surface.vertex_count, 0);
  for (const auto& [v, cone] : map.cones) stays[v] = 1;
  if (map.cones.empty()) stays[surface.triangles[0][0]] = 1;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (stays[v]) {
      kept.u.push_back(v);
      kept.v.push_back(v);
    } else {
      for (int i = 0; i < 2; ++i) kept.unknowns.number[2 * v + i] = kept.unknowns.count++;
    }
  }
  return kept;
}

}  // namespace

TurnedMaps::TurnedMaps(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Lines lines,
                       std::vector<int> chosen, std::shared_ptr<const Levels> levels)
    : surface_(std::move(surface)),
      options_(options),
      lines_(std::move(lines)),
      chosen_(std::move(chosen)),
      levels_(std::move(levels)) {
  if (surface_->intrinsic()) throw TopologyError("a turned map needs positions: the surface has edge lengths alone");
}

TurnedMaps::~TurnedMaps() = default;

void TurnedMaps::begin(Execution& execution) {
  if (level_.surface || !lines_.edges.empty()) return;
  std::vector<int> kept;
  for (int v = 0; v < std::ssize(chosen_); ++v) {
    if (chosen_[v] != 0) kept.push_back(v);
  }
  if (!levels_ || !kept.empty()) levels_ = std::make_shared<const Levels>(surface_, execution, std::move(kept));
  level_ = levels_->level(kLevelTriangles, execution);
  is_carried_ = !level_.is_whole(*surface_) && levels_->has_triangles();
}

// A short search on the level of the map, from those of least strain and price that are found on few triangles.
std::vector<int> TurnedMaps::cones_of(int first, const ConeOptions& wanted, Execution& execution) {
  execution.stage("cones", 0, 0.8);
  const Execution::Within within(execution);
  execution.stage("cones", 0, 1);
  const std::vector<int>& begun = start(first, execution).missing;
  std::vector<int> missing = refined_cones(*level_.surface, begun, wanted, execution).missing;
  return is_carried_ ? missing : moved(*surface_, level_.vertex, missing);
}

const TurnedMaps::Start& TurnedMaps::start(int first, Execution& execution) {
  Start& result = starts_[first];
  if (result.missing.empty()) result = best_start(options_of(first), execution);
  return result;
}

TurnedMaps::Start TurnedMaps::best_start(const ConeOptions& wanted, Execution& execution) const {
  // Where any direction will do there is one start, for which there may be more.
  const CoarseLevel coarse = levels_->level(wanted.along ? kFewTriangles : 2 * kFewTriangles, execution);
  const std::vector<Cones> found = find_cones(*coarse.surface, wanted, execution);
  const Cones* best = &found[0];
  double cost = kInfinity;
  std::pair<double, double> least{kInfinity, 0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto is_same = [&](const Cones& other) { return other.missing == found[i].missing; };
    if (std::any_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(i), is_same)) continue;
    const double part = static_cast<double>(i) / static_cast<double>(found.size());
    execution.part(part, part);
    const Execution::Within one(execution);
    execution.report(0);
    const PlacedCones placed(coarse.surface, wanted, found[i].missing, execution);
    const PlacedCones::Judged made = placed.best_map(wanted.tiles, uv::kUsualEvenness, 1, kDraft, execution);
    const std::pair<double, double> bad(made.bad.first, made.bad.second + found[i].price);
    if (bad < least) least = bad, best = &found[i];
    const uv::UvArray laid = corner_uv(*coarse.surface, placed.lattice(), made.map);
    const uv::Quality quality = uv::quality(*coarse.surface, laid, execution.workers());
    cost = std::min(cost, uv::cost_of_squares({quality.density_ratio, quality.mean_angle}));
  }
  std::vector<int> vertex = coarse.vertex;
  for (int& v : vertex) v = level_.collapsed[v];
  // Where all collapse on so few triangles, nothing is known.
  return {moved(*level_.surface, vertex, best->missing), std::isfinite(cost) ? cost : 0};
}

int TurnedMaps::first_of(double tiles) const {
  return std::clamp(static_cast<int>(std::lround(std::log2(options_.tiles / tiles))), 0, kMostLevels);
}

double TurnedMaps::guess(double tiles, Execution& execution) {
  const std::lock_guard lock(one_at_a_time_);
  if (!lines_.edges.empty() || !chosen_.empty()) return 0;
  begin(execution);
  return start(first_of(tiles), execution).cost;
}

ConeOptions TurnedMaps::options_of(int far) const {
  ConeOptions result = options_;
  result.tiles *= std::exp2(-far);
  return result;
}

const PlacedCones& TurnedMaps::placed(int first, int far, Execution& execution) {
  std::unique_ptr<const PlacedCones>& found = placed_[{first, far}];
  if (!found) {
    const ConeOptions wanted = options_of(far);
    if (!lines_.edges.empty()) {
      found = std::make_unique<PlacedCones>(surface_, wanted, lines_, execution);
    } else {
      std::vector<int> missing;
      if (chosen_.empty()) {
        missing = cones_of(first, wanted, execution);
      } else {
        const Net net(*made_on());
        missing.assign(net.vertex_count(), 0);
        for (int v = 0; v < std::ssize(chosen_); ++v) {
          if (chosen_[v] != 0) missing[is_carried_ ? level_.collapsed[v] : v] = chosen_[v];
        }
        missing = with_holes(net, wanted.k, missing, execution);
      }
      found = std::make_unique<PlacedCones>(made_on(), wanted, std::move(missing), execution);
    }
  }
  return *found;
}

LatticeMap TurnedMaps::on_surface(const LatticeMap& map, double evenness, Execution& execution) const {
  const TurnLattice lattice(options_.k);
  LatticeMap result = carried_map(*surface_, *levels_, level_, lattice, map, execution);
  join_polygons(*surface_, lattice, result);
  if (evenness == 0) return result;
  const uv::Kept kept = kept_of(*surface_, lattice, result);
  const bool is_large = static_cast<int>(surface_->triangles.size()) > kLightTriangles;
  const uv::UvArray delta = uv::evened(*surface_, corner_uv(*surface_, lattice, result), kept, evenness, execution,
                                       is_large ? kLight : kFine);
  for (int v = 0; v < surface_->vertex_count; ++v) result.y[v] += Complex(delta(v, 0), delta(v, 1));
  return result;
}

// Turns the frames of polygons until v runs up on most.
void TurnedMaps::turn_upright(LatticeMap& map) const {
  const TurnLattice lattice(options_.k);
  const Net net(*surface_);
  std::vector<int> turn(surface_->edges.size(), 0);
  for (const Jump& jump : jumps_of(*surface_, lattice, map)) turn[jump.edge] = jump.turn;
  const uv::UvArray laid = corner_uv(*surface_, lattice, map);
  turn_triangles(lattice, upright_turns(*surface_, net, laid, lattice.k, *options_.along, turn), map);
}

TurnedMap TurnedMaps::turned_map(double tiles, double evenness, Execution& execution) {
  const std::lock_guard lock(one_at_a_time_);
  begin(execution);
  const bool are_chosen = !chosen_.empty();
  const int first = are_chosen ? 0 : first_of(tiles);
  const int last = first + (are_chosen ? 0 : kFurtherApart);
  PlacedCones::Judged best;
  const PlacedCones* winner = nullptr;
  for (int level = first; level <= last; ++level) {
    const PlacedCones& tried = placed(first, level, execution);
    if (winner && tried.missing() == winner->missing()) continue;
    PlacedCones::Judged other =
        tried.best_map(tiles, evenness, lines_.edges.empty() ? kTries : kLinedTries, {}, execution);
    const bool helps = other.bad.first < kHelps * best.bad.first;
    if (other.bad < best.bad) best = std::move(other), winner = &tried;
    if (!helps || best.bad.first == 0) break;
  }
  TurnedMap result;
  const TurnLattice& lattice = winner->lattice();
  result.before = uv::quality(*made_on(), best.before, execution.workers());
  LatticeMap map = is_carried_ ? on_surface(best.map, evenness, execution) : std::move(best.map);
  // Sixth turns are exact to rounding alone: the fewer there are, the better.
  if (options_.along && options_.k != 6) turn_upright(map);
  result.uv = corner_uv(*surface_, lattice, map);
  result.jumps = jumps_of(*surface_, lattice, map);
  const Net net(*made_on());
  std::vector<std::pair<int, int>> cones;
  for (int v = 0; v < net.vertex_count(); ++v) {
    const int missing = winner->missing()[v];
    if (missing != 0 && !net.on_boundary[v]) cones.emplace_back(is_carried_ ? level_.vertex[v] : v, missing);
  }
  std::ranges::sort(cones);
  for (const auto& [v, missing] : cones) {
    result.cones.push_back(v);
    result.missing.push_back(missing);
  }
  execution.finish();
  return result;
}

}  // namespace holomorph::tiling
