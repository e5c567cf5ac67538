#include "turns/turned_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "evening/evening.h"
#include "tiling/greens/coarse_level.h"
#include "turns/chosen_cones.h"

namespace holomorph::turns {
namespace {

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
    const std::pair<double, double> strain = placed.badness(wanted.tiles, evening::kUsualEvenness, execution);
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

}  // namespace holomorph::turns
