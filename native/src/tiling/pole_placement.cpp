#include "tiling/pole_placement.h"

#include <iterator>

#include "base/errors.h"
#include "tiling/pole_objective.h"
#include "tiling/pole_search.h"

namespace holomorph::tiling {
namespace {

constexpr int kCounts[] = {2, 4, 8, 12, 16};       // of poles by themselves
constexpr int kFew = 4;                            // so many are placed by all samples,
constexpr int kEvery = 3;                          // more of them by every third one
constexpr double kEvenWithout = 3, kEvenWith = 5;  // spread of the density
constexpr double kHopeful = 2 * kEvenWith;  // only with a lower one a count is worth a search for the best places
constexpr double kWorth = 0.9;              // more poles are taken where the spread falls to this part of itself

Poles at_the_best_places(PoleSearch& search, Poles poles) {
  poles = search.settled(std::move(poles));
  return static_cast<int>(poles.vertices.size()) > kFew ? search.pruned(std::move(poles)) : poles;
}

}  // namespace

Poles placed_poles(Landscape& landscape, const PlacementRules& rules, int count, Execution& execution) {
  if (count < least_count(landscape) || (count == 1 && landscape.closed())) {
    throw TopologyError(std::to_string(count) + (count == 1 ? " pole is" : " poles are") + " not enough: " +
                        (landscape.closed() ? "on a closed surface the residues sum to 0, so two or more are needed"
                                            : "a disk needs one or more"));
  }
  PoleSearch search(landscape, rules, count <= kFew ? 1 : kEvery, execution);
  Poles poles = search.begin();
  if (!search.add(poles, count)) {
    throw TopologyError("there is room for " + std::to_string(poles.vertices.size()) + " poles, not for " +
                        std::to_string(count) + ": their stars must be apart; take fewer, or subdivide the mesh");
  }
  if (static_cast<int>(rules.fixed.size()) < count) poles = at_the_best_places(search, std::move(poles));
  return optimised(landscape, rules, std::move(poles), execution);
}

Poles placed_poles(Landscape& landscape, const PlacementRules& rules, Execution& execution) {
  PoleSearch few(landscape, rules, 1, execution), more(landscape, rules, kEvery, execution);
  Poles added = few.begin(), best = added;
  double least = few.spread_of(best);
  for (const int count : kCounts) {
    PoleSearch& search = count <= kFew ? few : more;
    if (least <= (best.vertices.empty() ? kEvenWithout : kEvenWith) || !search.add(added, count)) break;
    search.sweep(added);
    if (count == *std::rbegin(kCounts) || search.spread_of(added) < kHopeful)
      added = at_the_best_places(search, std::move(added));
    const double spread = search.spread_of(added);
    if (spread > kWorth * least) continue;
    least = spread;
    best = added;
  }
  return optimised(landscape, rules, std::move(best), execution);
}

Poles optimised(Landscape& landscape, const PlacementRules& rules, Poles start, Execution& execution) {
  PoleObjective objective(landscape, rules.kind);
  objective.prepare(start.vertices, execution);
  objective.optimise(start, {uv::kDensityFloor}, execution);
  return start;
}

}  // namespace holomorph::tiling
