#include "tiling/poles/pole_placement.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "tiling/poles/pole_objective.h"
#include "tiling/poles/search_steps.h"
#include "uv/balance.h"
#include "uv/evening.h"

namespace holomorph::tiling {
namespace {

// The search for poles of even density: steps that add, move, relocate and prune them.

class PoleSearch : private SearchSteps {
 public:
  using SearchSteps::SearchSteps;

  /// Returns the best form with the fixed poles or, without any, with as few poles as possible.
  MeromorphicForm begin();
  /// Adds poles up to `count`, one by one where they help most. @return whether there was room for all
  bool add(MeromorphicForm& form, int count);
  /// Moves each pole in turn to where it does best beside the others. @return whether one moved
  bool sweep(MeromorphicForm& form);
  /// Moves poles, and removes those that matter least and adds them anew. Ends where nothing is gained, or the spread
  /// is small enough. Their number stays.
  MeromorphicForm settled(MeromorphicForm form, double enough = 0);
  /// Places extra poles and keeps the best, where that is more even. This reaches optima that relocating one pole after
  /// the other does not. @pre more than a few poles
  MeromorphicForm pruned(MeromorphicForm form);
  /// Moves each pole in turn to where it is less visible, while the objective grows by a tenth at most. That is a
  /// twentieth of the evened density's spread. @pre the surface has positions
  MeromorphicForm hidden(MeromorphicForm form);
  double spread_of(const MeromorphicForm& form) const { return spread(density(form, greens_)); }

 private:
  void refit(MeromorphicForm& form);
  bool is_fixed(int vertex) const { return std::ranges::find(options_.fixed, vertex) != options_.fixed.end(); }
  void fill(MeromorphicForm& form, int count);
  void sweep_to_the_end(MeromorphicForm& form);
  bool relocate(MeromorphicForm& form);
  std::optional<MeromorphicForm> least_missed(MeromorphicForm form, const std::vector<int>& stay, Index least);
};

constexpr int kRounds = 3, kSweeps = 5;
constexpr int kRelocated = 8;  // poles that are removed and added anew, at most
constexpr int kSpare = 4;      // poles that are placed beyond the number wanted, and removed again
// Hiding: the part by which the objective may grow in all, and the weight of exposure relative to the objective.
constexpr double kHiding = 0.1, kWorthHiding = 1;
// Floors of the density, one descent for each. High floors give a smoother objective; the last one is wanted.
const std::vector<double> kFromAfar = {1.0, 0.1, 0.01, 1e-3, uv::kDensityFloor};

// The first pole of a form that the other one lacks.
int lost(const MeromorphicForm& form, const MeromorphicForm& other) {
  const auto is_missing = [&](int v) { return std::ranges::find(other.poles, v) == other.poles.end(); };
  return held(std::ranges::find_if(form.poles, is_missing), form.poles);
}

// Moves the first pole to the end of the lists.
void first_to_last(MeromorphicForm& form) {
  std::rotate(form.poles.begin(), form.poles.begin() + 1, form.poles.end());
  std::rotate(form.residues.begin(), form.residues.begin() + 1, form.residues.end());
}

// Removes the last pole; the others share its residue where the sum has to be 0.
MeromorphicForm without_last(MeromorphicForm form, bool closed) {
  const Index k = form.residues.size() - 1;
  const Complex last = form.residues[k];
  form.poles.pop_back();
  form.residues.conservativeResize(k);
  if (closed) form.residues.array() += last / static_cast<double>(k);
  return form;
}

// Returns the least number of poles that a form on this surface needs.
int least_count(const PoleBasis& basis) { return basis.form_count() > 0 ? 0 : basis.closed() ? 2 : 1; }

MeromorphicForm PoleSearch::begin() {
  MeromorphicForm form;
  form.poles = options_.fixed;
  if (form.poles.empty() && basis_.form_count() == 0) form.poles = candidates_.first();
  const auto k = static_cast<Index>(form.poles.size());
  BalancedForm* const balanced = k == 0 ? options_.balanced.get() : nullptr;
  if (balanced && balanced->every == every_) return balanced->form;
  form.residues = VectorXcd::Ones(k);
  if (basis_.closed() && k > 0) form.residues[k - 1] = -static_cast<double>(k - 1);
  form.coefficients = VectorXcd::Zero(basis_.form_count());
  if (basis_.form_count() > 0 && k == 0) {
    form.coefficients = basis_.form_count() == 1 ? VectorXcd::Ones(1)
                                                 : uv::lowest_variance(basis_.surface(), basis_.samples(),
                                                                       basis_.holomorphic(), options_.kind, execution_);
  }
  objective_.prepare(form.poles, k, execution_);
  // The balance of many forms alone is a minimum already.
  objective_.fit(form, k == 0 && objective_.has_many_forms() ? kFromNear : kFromAfar, tick_);
  if (balanced) *balanced = {every_, form};
  return form;
}

bool PoleSearch::add(MeromorphicForm& form, int count) {
  fill(form, count);
  refit(form);
  return std::ssize(form.poles) >= count;
}

void PoleSearch::fill(MeromorphicForm& form, int count) {
  while (std::ssize(form.poles) < count && add_one(form)) {
  }
}

bool PoleSearch::sweep(MeromorphicForm& form) {
  bool moved = false;
  for (Index i = 0; i < form.residues.size(); ++i) {
    if (!is_fixed(form.poles[i])) moved |= exchange(form, i);
  }
  if (moved) refit(form);
  return moved;
}

MeromorphicForm PoleSearch::settled(MeromorphicForm form, double enough) {
  sweep_to_the_end(form);
  for (int round = 1; round < kRounds && spread_of(form) > enough && relocate(form); ++round) sweep_to_the_end(form);
  return form;
}

MeromorphicForm PoleSearch::pruned(MeromorphicForm form) {
  const std::size_t count = form.poles.size();
  MeromorphicForm other = form;
  add(other, static_cast<int>(count) + kSpare);
  sweep(other);
  while (other.poles.size() > count) {
    auto fewer = least_missed(other, options_.fixed, static_cast<Index>(count));
    if (!fewer) return form;
    other = std::move(*fewer);
  }
  sweep_to_the_end(other);
  const auto ratio = [&](const MeromorphicForm& each) { return density_ratio(density(each, greens_)); };
  return ratio(other) < ratio(form) ? other : form;
}

MeromorphicForm PoleSearch::hidden(MeromorphicForm form) {
  if (basis_.surface().intrinsic() || form.poles.empty()) return form;
  begin_hiding(form.poles, kWorthHiding * form.objective,
               kHiding * form.objective / static_cast<double>(form.poles.size()));
  sweep(form);
  end_hiding();
  return form;
}

// Fits all coefficients of many forms, whose ratios were kept while places were compared.
void PoleSearch::refit(MeromorphicForm& form) {
  if (objective_.has_many_forms()) objective_.fit(form, kFromNear, tick_);
}

// Sweeps until every pole in turn has stayed in its place.
void PoleSearch::sweep_to_the_end(MeromorphicForm& form) {
  const Index count = form.residues.size();
  Index unmoved = 0;
  for (int i = 0; i < kSweeps; ++i) {
    bool moved = false;
    for (Index j = 0; j < count && unmoved < count; ++j) {
      const bool better = !is_fixed(form.poles[j]) && exchange(form, j);
      moved |= better;
      unmoved = better ? 0 : unmoved + 1;
    }
    if (!moved) return;
    refit(form);
  }
}

// Removes the poles that matter least, one at a time, and adds one instead where it does best, with a residue of its
// own.
// @return whether that was better
bool PoleSearch::relocate(MeromorphicForm& form) {
  const std::size_t count = form.poles.size();
  bool moved = false;
  std::vector<int> stay = options_.fixed;
  for (int i = 0; i < kRelocated; ++i) {
    const auto least = least_missed(form, stay, least_count(basis_));
    if (!least) break;
    MeromorphicForm other = *least;
    // The next round removes another pole.
    stay.push_back(lost(form, other));
    fill(other, static_cast<int>(count));
    if (other.poles.size() < count) continue;
    exchange(other, std::ssize(least->poles));
    if (other.objective > form.objective * (1 - kGain)) continue;
    form = std::move(other);
    moved = true;
  }
  return moved;
}

// Returns the form without the pole that is missed least. @param least number of poles that have to be left
std::optional<MeromorphicForm> PoleSearch::least_missed(MeromorphicForm form, const std::vector<int>& stay,
                                                        Index least) {
  std::vector<MeromorphicForm> tried;
  const auto count = static_cast<Index>(form.poles.size());
  for (Index i = 0; i < count; ++i) {
    first_to_last(form);  // each becomes the last one once
    if (count - 1 >= least && std::ranges::find(stay, form.poles.back()) == stay.end())
      tried.push_back(without_last(form, basis_.closed()));
  }
  if (tried.empty()) return std::nullopt;
  return best_optimised(std::move(tried), kFromNear);
}

constexpr int kCounts[] = {2, 4, 8, 12, 16};       // numbers of poles that are tried
constexpr int kFew = 4;                            // up to this number, poles are placed by all samples,
constexpr int kEvery = 3;                          // more of them by every third one,
constexpr int kManyFormsToPlace = 64;              // and all poles where there are as many forms as this
constexpr double kEvenWithout = 3, kEvenWith = 5;  // spread of the density
constexpr double kHopeful = 2 * kEvenWith;  // only with a lower one a count is worth a search for the best places
constexpr int kCountsEvened[] = {2, 3, 4, 6, 8, 10, 12, 14, 16};
constexpr double kEvenedWithout = 2.85, kEvened = 2.75;  // spread of the evened density
constexpr double kHopefulEvened = 1.2 * kEvened;
constexpr double kUsualDescent = 30;      // usual evaluations of the objective in the last descent
constexpr double kDescentOperations = 4;  // of an evaluation, for each sample and form
constexpr double kWorth = 0.9;            // more poles are taken where the spread falls to this part of itself

// The stride of the samples in a search for this number of poles.
int thinning(const GreensFunctions& greens, int count) {
  return count <= kFew && greens.basis().form_count() < kManyFormsToPlace ? 1 : kEvery;
}

// The spread of the density that evening is expected to leave.
double evened_spread(double spread) { return std::pow(spread, uv::kUsualPower); }

MeromorphicForm at_the_best_places(PoleSearch& search, MeromorphicForm form) {
  form = search.settled(std::move(form));
  return static_cast<int>(form.poles.size()) > kFew ? search.pruned(std::move(form)) : form;
}

// Finds the number of poles for an evened map. Poles move to their best places only for numbers with which that may be
// enough, and so for few.
MeromorphicForm enough_for_evening(GreensFunctions& greens, const PlaceOptions& options, Execution& execution) {
  PoleSearch few(greens, options, thinning(greens, kFew), execution), more(greens, options, kEvery, execution);
  // The spread of the conformal map that evening takes to kEvened.
  const double enough = std::pow(kEvened, 1 / uv::kUsualPower);
  MeromorphicForm added = few.begin(), best = added;
  double least = evened_spread(few.spread_of(best));
  for (const int count : kCountsEvened) {
    PoleSearch& search = count <= kFew ? few : more;
    if (least <= (best.poles.empty() ? kEvenedWithout : kEvened) || !search.add(added, count)) break;
    search.sweep(added);
    if (count == *std::rbegin(kCountsEvened) || evened_spread(search.spread_of(added)) < kHopefulEvened)
      added = search.settled(std::move(added), enough);
    const double spread = evened_spread(search.spread_of(added));
    if (spread >= least && added.objective > kWorth * best.objective) continue;
    least = spread;
    best = added;
  }
  best = (std::ssize(best.poles) <= kFew ? few : more).hidden(std::move(best));
  return optimised(greens, options.kind, std::move(best), execution);
}

MeromorphicForm enough(GreensFunctions& greens, const PlaceOptions& options, Execution& execution) {
  PoleSearch few(greens, options, thinning(greens, kFew), execution), more(greens, options, kEvery, execution);
  MeromorphicForm added = few.begin(), best = added;
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
  return optimised(greens, options.kind, std::move(best), execution);
}

// Places this number of poles.
MeromorphicForm so_many(GreensFunctions& greens, const PlaceOptions& options, int count, Execution& execution) {
  PoleSearch search(greens, options, thinning(greens, count), execution);
  MeromorphicForm form = search.begin();
  if (!search.add(form, count)) {
    throw TopologyError("there is room for " + std::to_string(form.poles.size()) + " of " + std::to_string(count) +
                        " poles: the faces around them must not touch; take fewer, or subdivide the mesh");
  }
  if (static_cast<int>(options.fixed.size()) < count) form = at_the_best_places(search, std::move(form));
  return optimised(greens, options.kind, std::move(form), execution);
}

}  // namespace

MeromorphicForm placed_poles(GreensFunctions& greens, const PlaceOptions& options, int count, Execution& execution) {
  if (count < least_count(greens.basis()) || (count == 1 && greens.basis().closed())) {
    throw TopologyError(std::to_string(count) + (count == 1 ? " pole is" : " poles are") + " not enough: " +
                        (greens.basis().closed()
                             ? "on a closed surface the residues sum to 0, so two or more are needed"
                             : "a disk needs one or more"));
  }
  return so_many(greens, options, count, execution);
}

MeromorphicForm placed_poles(GreensFunctions& greens, const PlaceOptions& options, Execution& execution) {
  return (options.evened ? enough_for_evening : enough)(greens, options, execution);
}

MeromorphicForm optimised(GreensFunctions& greens, uv::Coefficients kind, MeromorphicForm start, Execution& execution) {
  PoleObjective objective(greens, kind);
  objective.prepare(start.poles, start.residues.size(), execution);
  const auto samples = static_cast<double>(greens.basis().holomorphic().M.size());
  TaskProgress watch(execution, kUsualDescent, kDescentOperations * samples);
  objective.fit(start, {uv::kDensityFloor}, [&] { watch(0); });
  return start;
}

}  // namespace holomorph::tiling
