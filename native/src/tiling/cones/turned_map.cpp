#include "tiling/cones/turned_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "base/execution.h"
#include "tiling/cones/net.h"
#include "tiling/cones/scale_form.h"
#include "tiling/greens/pole_basis.h"
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

constexpr int kFewTriangles = 4000, kMoreTriangles = 20'000;  // of the levels on which cones are searched for
constexpr int kCompared = 5;                                  // of the cones found on the fewer
constexpr int kMostLevels = 4;                                // of half the tiles each, for which cones are searched
constexpr int kFurtherApart = 2;                              // levels, where triangles are flipped
constexpr double kHelps = 0.5;                                // of the wrong area: else no more is tried

// Cones on a surface, from those of a level of it: #V.
std::vector<int> carried(const mesh::Surface& surface, const tiling::CoarseLevel& level, const Cones& cones) {
  const Net net(surface);
  std::vector<int> missing(surface.vertex_count, 0);
  for (std::size_t v = 0; v < cones.missing.size(); ++v) {
    if (cones.missing[v] != 0) missing[place_of(net, level.vertex[v])] += cones.missing[v];
  }
  return missing;
}

// The cones with the least strain among those of least cost of many starts on few triangles, then a short search on
// more.
std::vector<int> cones_of(const std::shared_ptr<const mesh::Surface>& surface, const ConeOptions& wanted,
                          Execution& execution) {
  execution.stage("cones", 0, 0.8);
  const Execution::Within within(execution);
  execution.stage("cones", 0, 1);
  const tiling::CoarseLevel fine = tiling::coarse_level(surface, execution, kMoreTriangles);
  const tiling::CoarseLevel coarse = tiling::coarse_level(fine.surface, execution, kFewTriangles);
  std::vector<Cones> found = find_cones(*coarse.surface, wanted, execution);
  found.resize(std::min<std::size_t>(found.size(), kCompared));
  const Cones* best = nullptr;
  std::pair<double, double> least;
  for (const Cones& cones : found) {
    execution.report(1);
    const PlacedCones placed(coarse.surface, wanted, cones.missing, execution);
    const std::pair<double, double> strain = placed.badness(wanted.tiles, uv::kUsualEvenness, execution);
    if (best == nullptr || strain < least) least = strain, best = &cones;
  }
  return carried(*surface, fine,
                 refined_cones(*fine.surface, carried(*fine.surface, coarse, *best), wanted, execution));
}

}  // namespace

TurnedMaps::TurnedMaps(std::shared_ptr<const mesh::Surface> surface, const ConeOptions& options, Lines lines,
                       std::vector<int> chosen)
    : surface_(std::move(surface)), options_(options), lines_(std::move(lines)), chosen_(std::move(chosen)) {
  if (surface_->intrinsic()) throw TopologyError("a turned map needs positions: the surface has edge lengths alone");
}

TurnedMaps::~TurnedMaps() = default;

const PlacedCones& TurnedMaps::placed(int level, Execution& execution) {
  std::unique_ptr<const PlacedCones>& found = placed_[level];
  if (!found) {
    ConeOptions wanted = options_;
    wanted.tiles *= std::exp2(-level);
    if (!chosen_.empty()) {
      std::vector<int> missing = with_holes(Net(*surface_), wanted.k, chosen_, execution);
      found = std::make_unique<PlacedCones>(surface_, wanted, std::move(missing), execution);
    } else if (lines_.edges.empty()) {
      found = std::make_unique<PlacedCones>(surface_, wanted, cones_of(surface_, wanted, execution), execution);
    } else {
      found = std::make_unique<PlacedCones>(surface_, wanted, lines_, execution);
    }
  }
  return *found;
}

TurnedMap TurnedMaps::turned_map(double tiles, double evenness, Execution& execution) {
  const std::lock_guard lock(one_at_a_time_);
  const double times = options_.tiles / tiles;
  const bool are_chosen = !chosen_.empty();
  const int first = are_chosen ? 0 : std::clamp(static_cast<int>(std::lround(std::log2(times))), 0, kMostLevels);
  const int last = first + (are_chosen ? 0 : kFurtherApart);
  PlacedCones::Judged best;
  const PlacedCones* winner = nullptr;
  const Effort effort(*surface_);
  for (int level = first; level <= last; ++level) {
    const PlacedCones& tried = placed(level, execution);
    if (winner && tried.missing() == winner->missing()) continue;
    PlacedCones::Judged other = tried.best_map(tiles, evenness, effort, execution);
    const bool helps = other.bad.first < kHelps * best.bad.first, is_last = other.is_last;
    if (other.bad < best.bad) best = std::move(other), winner = &tried;
    if (!helps || is_last) break;
  }
  // Sixth turns are exact to rounding alone: the fewer there are, the better.
  if (winner && options_.along && options_.k != 6) winner->turn_upright(best.map, *options_.along);
  execution.finish();
  return std::move(best.map);
}

}  // namespace holomorph::tiling
