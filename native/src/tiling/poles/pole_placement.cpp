#include "tiling/poles/pole_placement.h"

#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "base/errors.h"
#include "evening/evening.h"
#include "tiling/poles/pole_objective.h"
#include "tiling/poles/pole_search.h"

namespace holomorph::tiling {
namespace {

constexpr int kCounts[] = {2, 4, 8, 12, 16};       // numbers of poles that are tried
constexpr int kFew = 4;                            // up to this number, poles are placed by all samples,
constexpr int kEvery = 3;                          // more of them by every third one,
constexpr int kManyForms = 64;                     // and all poles where there are as many forms as this
constexpr double kEvenWithout = 3, kEvenWith = 5;  // spread of the density
constexpr double kHopeful = 2 * kEvenWith;  // only with a lower one a count is worth a search for the best places
constexpr int kCountsEvened[] = {2, 3, 4, 6, 8, 10, 12, 14, 16};
constexpr double kEvenedWithout = 2.85, kEvened = 2.75;  // spread of the evened density
constexpr double kHopefulEvened = 1.2 * kEvened;
constexpr double kAllowed = 3;                             // the same, where hiding and a mirror have cost some
constexpr double kUsualValues = 30;                        // usual evaluations of the objective in the last descent
constexpr double kMirrorCosts = 1.25, kMirrorPoles = 1.5;  // at most, of the (evened) ratio, and of poles
constexpr int kFewMirrored = 8;  // up to this number, mirrored poles that are enough need no comparison
constexpr double kWorth = 0.9;   // more poles are taken where the spread falls to this part of itself

// The stride of the samples in a search for this number of poles.
int thinning(const GreensFunctions& greens, int count) {
  return count <= kFew && greens.basis().form_count() < kManyForms ? 1 : kEvery;
}

// The spread of the density that evening is expected to leave.
double evened(double spread) { return std::pow(spread, evening::kUsualPower); }

MeromorphicForm at_the_best_places(PoleSearch& search, MeromorphicForm form) {
  form = search.settled(std::move(form));
  return static_cast<int>(form.poles.size()) > kFew ? search.pruned(std::move(form)) : form;
}

// Finds the number of poles for an evened map. Poles move to their best places only for numbers with which that may be
// enough, and so for few.
MeromorphicForm enough_for_evening(GreensFunctions& greens, const PlaceOptions& options, Execution& execution) {
  PoleSearch few(greens, options, thinning(greens, kFew), execution), more(greens, options, kEvery, execution);
  // The spread of the conformal map that evening takes to kEvened.
  const double enough = std::pow(kEvened, 1 / evening::kUsualPower);
  MeromorphicForm added = few.begin(), best = added;
  if (options.mirror && added.poles.empty()) return added;
  double least = evened(few.spread_of(best));
  for (const int count : kCountsEvened) {
    if (options.mirror && count % 2 == 1) continue;  // which would ask for a pole on the plane
    PoleSearch& search = count <= kFew ? few : more;
    if (least <= (best.poles.empty() ? kEvenedWithout : kEvened) || !search.add(added, count)) break;
    search.sweep(added);
    if (count == *std::rbegin(kCountsEvened) || evened(search.spread_of(added)) < kHopefulEvened)
      added = search.settled(std::move(added), enough);
    const double spread = evened(search.spread_of(added));
    if (spread >= least && added.objective > kWorth * best.objective) continue;
    least = spread;
    best = added;
  }
  best = (std::ssize(best.poles) <= kFew ? few : more).hidden(std::move(best));
  return optimised(greens, options.kind, options.mirror, std::move(best), execution);
}

MeromorphicForm enough(GreensFunctions& greens, const PlaceOptions& options, Execution& execution) {
  PoleSearch few(greens, options, thinning(greens, kFew), execution), more(greens, options, kEvery, execution);
  MeromorphicForm added = few.begin(), best = added;
  if (options.mirror && added.poles.empty()) return added;
  double least = few.spread_of(best);
  for (const int count : kCounts) {
    PoleSearch& search = count <= kFew ? few : more;
    if (least <= (best.poles.empty() ? kEvenWithout : kEvenWith) || !search.add(added, count)) break;
    search.sweep(added);
    if (count == *std::rbegin(kCounts) || search.spread_of(added) < kHopeful)
      added = at_the_best_places(search, std::move(added));
    const double spread = search.spread_of(added);
    if (spread > kWorth * least) continue;
    least = spread;
    best = added;
  }
  return optimised(greens, options.kind, options.mirror, std::move(best), execution);
}

// Places this number of poles. With a mirror it returns none where there is no room for them in pairs.
MeromorphicForm so_many(GreensFunctions& greens, const PlaceOptions& options, int count, Execution& execution) {
  PoleSearch search(greens, options, thinning(greens, count), execution);
  MeromorphicForm form = search.begin();
  if (!search.add(form, count) || std::ssize(form.poles) < count) {
    if (options.mirror) return {};
    throw TopologyError("there is room for " + std::to_string(form.poles.size()) + " of " + std::to_string(count) +
                        " poles: the faces around them must not touch; take fewer, or subdivide the mesh");
  }
  if (static_cast<int>(options.fixed.size()) < count) form = at_the_best_places(search, std::move(form));
  return optimised(greens, options.kind, options.mirror, std::move(form), execution);
}

// Returns what `place` finds, with the mirror if that is hardly less even and takes hardly more poles.
// @param options afterwards without the mirror if the result has none
MeromorphicForm mirrored_or_not(GreensFunctions& greens, PlaceOptions& options,
                                const std::function<MeromorphicForm()>& place) {
  MeromorphicForm mirrored = place();
  if (!options.mirror) return mirrored;
  const bool does = options.evened && !mirrored.poles.empty() && std::ssize(mirrored.poles) <= kFewMirrored &&
                    evened(spread(density(mirrored, greens))) <= kAllowed;
  if (does) return mirrored;
  const Mirror* mirror = std::exchange(options.mirror, nullptr);
  MeromorphicForm other = place();
  const auto ratio = [&](const MeromorphicForm& form) {
    const double conformal = density_ratio(density(form, greens));
    return options.evened ? evened(conformal) : conformal;
  };
  const auto count = [](const MeromorphicForm& form) { return static_cast<double>(form.poles.size()); };
  if (mirrored.poles.empty() || ratio(mirrored) > kMirrorCosts * ratio(other) ||
      count(mirrored) > kMirrorPoles * count(other))
    return other;
  options.mirror = mirror;
  return mirrored;
}

}  // namespace

MeromorphicForm placed_poles(GreensFunctions& greens, PlaceOptions& options, int count, Execution& execution) {
  if (count < least_count(greens.basis()) || (count == 1 && greens.basis().closed())) {
    throw TopologyError(std::to_string(count) + (count == 1 ? " pole is" : " poles are") + " not enough: " +
                        (greens.basis().closed()
                             ? "on a closed surface the residues sum to 0, so two or more are needed"
                             : "a disk needs one or more"));
  }
  return mirrored_or_not(greens, options, [&] { return so_many(greens, options, count, execution); });
}

MeromorphicForm placed_poles(GreensFunctions& greens, PlaceOptions& options, Execution& execution) {
  const auto place = options.evened ? enough_for_evening : enough;
  return mirrored_or_not(greens, options, [&] { return place(greens, options, execution); });
}

MeromorphicForm optimised(GreensFunctions& greens, uv::Coefficients kind, const Mirror* mirror, MeromorphicForm start,
                          Execution& execution) {
  PoleObjective objective(greens, kind, 1, mirror);
  objective.prepare(start.poles, start.residues.size(), execution);
  Watch watch(execution, kUsualValues);
  objective.fit(start, {uv::kDensityFloor}, [&] { watch(0); });
  return start;
}

}  // namespace holomorph::tiling
