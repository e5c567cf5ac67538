#include "tiling/poles/pole_search.h"

#include <cmath>

#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

constexpr int kRounds = 3, kSweeps = 5;
constexpr int kRelocated = 8;  // poles that are removed and added anew, at most
constexpr int kSpare = 4;      // poles that are placed beyond the number wanted, and removed again
// Hiding: the part by which the objective may grow in all, and the weight of exposure relative to the objective.
constexpr double kHiding = 0.1, kWorth = 1;
// Floors of the density, one descent for each. High floors give a smoother objective; the last one is wanted.
const std::vector<double> kFromAfar = {1.0, 0.1, 0.01, 1e-3, uv::kDensityFloor};

// The first pole of a form that the other one lacks.
int lost(const MeromorphicForm& form, const MeromorphicForm& other) {
  return *std::ranges::find_if(form.poles,
                               [&](int v) { return std::ranges::find(other.poles, v) == other.poles.end(); });
}

}  // namespace

int least_count(const PoleBasis& basis) { return basis.form_count() > 0 ? 0 : basis.closed() ? 2 : 1; }

MeromorphicForm PoleSearch::begin() {
  MeromorphicForm form;
  form.poles = options_.fixed;
  if (form.poles.empty() && basis_.form_count() == 0) form.poles = candidates_.first();
  const auto k = static_cast<Index>(form.poles.size());
  if (options_.mirror && k == 0) return form;  // there is no room
  form.residues = VectorXcd::Ones(k);
  if (basis_.closed() && k > 0) form.residues[k - 1] = -static_cast<double>(k - 1);
  // Images have conjugate residues that sum to 0: i and -i.
  if (k > 0 && is_pair(form.poles[0])) form.residues *= Complex(0, 1);
  form.coefficients = VectorXcd::Zero(basis_.form_count());
  if (basis_.form_count() > 0 && k == 0) {
    form.coefficients = basis_.form_count() == 1 ? VectorXcd::Ones(1)
                                                 : uv::lowest_variance(basis_.surface(), basis_.samples(),
                                                                       basis_.holomorphic(), options_.kind, execution_);
  }
  objective_.prepare(form.poles, k, execution_);
  // The balance of many forms alone is a minimum already.
  objective_.fit(form, k == 0 && objective_.has_many_forms() ? kFromNear : kFromAfar, tick_);
  return form;
}

bool PoleSearch::add(MeromorphicForm& form, int count) {
  if (options_.mirror && form.poles.empty()) return false;  // there was no room for the first ones
  fill(form, count);
  refit(form);
  const int missing = count - static_cast<int>(form.poles.size());
  return missing <= (options_.mirror ? 1 : 0);
}

void PoleSearch::fill(MeromorphicForm& form, int count) {
  while (std::ssize(form.poles) < count && add_one(form, count - static_cast<int>(form.poles.size()))) {
  }
}

bool PoleSearch::sweep(MeromorphicForm& form) {
  bool moved = false;
  for (Index i = 0; i < form.residues.size(); ++i) {
    if (!is_fixed(form.poles[i]) && orbit_size(form, i) > 0) moved |= exchange(form, i);
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
  if (basis_.surface().intrinsic() || form.poles.empty() || basis_.has_jacobian()) return form;
  begin_hiding(form.poles, kWorth * form.objective, kHiding * form.objective / static_cast<double>(form.poles.size()));
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
      const bool better = !is_fixed(form.poles[j]) && orbit_size(form, j) > 0 && exchange(form, j);
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

// Returns the form without the pole, or the pair, that is missed least. @param least number of poles that have to be
// left
std::optional<MeromorphicForm> PoleSearch::least_missed(MeromorphicForm form, const std::vector<int>& stay,
                                                        Index least) {
  std::vector<MeromorphicForm> tried;
  const auto count = static_cast<Index>(form.poles.size());
  for (Index i = 0; i < count;) {
    const Index size = first_to_last(form, options_.mirror);  // each becomes the last one once
    i += size;
    if (count - size >= least && std::ranges::find(stay, form.poles[count - size]) == stay.end())
      tried.push_back(without_last(form, size, basis_.closed()));
  }
  if (tried.empty()) return std::nullopt;
  return best_optimised(std::move(tried), kFromNear);
}

}  // namespace holomorph::tiling
