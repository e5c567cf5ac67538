#include "tiling/poles/pole_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

constexpr int kThinning = 3;  // a third of the samples tells what is worth a trial
// Candidates that are optimised when a pole is added, beside these on a plane, and when one moves.
constexpr int kTried = 4, kTriedOnPlane = 2, kRefined = 2;
constexpr int kRounds = 3, kSweeps = 5;
constexpr int kSpare = 4;              // so many more poles are placed, and taken away again
constexpr double kGain = 1e-3;         // less is no gain
constexpr double kUsualValues = 3000;  // of the objective, in a search
// Residues that a new pole is tried with, relative to the root of mean density times area.
constexpr double kTrialSizes[] = {0.1, 0.3, 1.0};
constexpr int kTrialPhases = 6;
const std::vector<double> kFromAfar = {1.0, 0.1, 0.01, 1e-3, uv::kDensityFloor}, kFromNear = {uv::kDensityFloor},
                          kWithTrial = {0.03, uv::kDensityFloor};

VectorXcd thinned(const VectorXcd& samples) { return samples(Eigen::seq(0, Eigen::last, kThinning)); }

}  // namespace

int least_count(const PoleBasis& basis) { return basis.form_count() > 0 ? 0 : basis.closed() ? 2 : 1; }

PoleSearch::PoleSearch(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution)
    : greens_(greens),
      basis_(greens.basis()),
      options_(options),
      execution_(execution),
      candidates_(basis_, options),
      every_(every),
      objective_(greens, options.kind, every, options.mirror),
      scores_(greens, every * kThinning, options.mirror),
      watch_(execution, kUsualValues) {}

MeromorphicForm PoleSearch::begin() {
  MeromorphicForm form;
  form.poles = options_.fixed;
  if (form.poles.empty() && basis_.form_count() == 0) form.poles = candidates_.first();
  const auto k = static_cast<Index>(form.poles.size());
  if (options_.mirror && k == 0) return form;  // there is no room
  form.residues = VectorXcd::Ones(k);
  if (basis_.closed() && k > 0) form.residues[k - 1] = -static_cast<double>(k - 1);
  if (k > 0 && is_pair(form.poles[0])) form.residues *= Complex(0, 1);
  form.coefficients = VectorXcd::Zero(basis_.form_count());
  if (basis_.form_count() > 0 && k == 0) {
    form.coefficients = basis_.form_count() == 1 ? VectorXcd::Ones(1)
                                                 : uv::lowest_variance(basis_.surface(), basis_.samples(),
                                                                       basis_.holomorphic(), options_.kind, execution_);
  }
  objective_.prepare(form.poles, k, execution_);
  objective_.fit(form, kFromAfar, tick_);
  return form;
}

bool PoleSearch::add(MeromorphicForm& form, int count) {
  fill(form, count);
  refit(form);
  const int missing = count - static_cast<int>(form.poles.size());
  return options_.mirror ? missing <= 1 && !form.poles.empty() : missing <= 0;
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

MeromorphicForm PoleSearch::settled(MeromorphicForm form) {
  sweep_to_the_end(form);
  for (int round = 1; round < kRounds && relocate(form); ++round) sweep_to_the_end(form);
  return form;
}

MeromorphicForm PoleSearch::pruned(MeromorphicForm form) {
  const std::size_t count = form.poles.size();
  MeromorphicForm other = form;
  add(other, static_cast<int>(count) + kSpare);
  sweep(other);
  while (other.poles.size() > count) {
    std::vector<MeromorphicForm> tried;
    for (Index i = 0; i < other.residues.size();) {
      const Index size = first_to_last(other, options_.mirror);  // each becomes the last one once
      i += size;
      if (!is_fixed(other.poles.back()) && other.poles.size() >= count + size)
        tried.push_back(without_last(other, size, basis_.closed()));
    }
    if (tried.empty()) return form;
    other = best_optimised(std::move(tried), kFromNear);
  }
  sweep_to_the_end(other);
  const auto ratio = [&](const MeromorphicForm& each) { return density_ratio(density(each, greens_)); };
  return ratio(other) < ratio(form) ? other : form;
}

// The coefficients of many forms, which stay behind while places are compared.
void PoleSearch::refit(MeromorphicForm& form) {
  if (objective_.has_many_forms()) objective_.fit(form, kFromNear, tick_);
}

// Until every pole has stayed where it is beside the others as they are.
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

// Takes each pole away and adds one where it does best, with a residue of its own. @return whether that was better
bool PoleSearch::relocate(MeromorphicForm& form) {
  const auto count = static_cast<Index>(form.poles.size());
  bool moved = false;
  for (Index i = 0; i < count;) {
    const Index size = first_to_last(form, options_.mirror);  // each becomes the last one once
    i += size;
    if (is_fixed(form.poles.back()) || count - size < least_count(basis_)) continue;
    MeromorphicForm other = without_last(form, size, basis_.closed());
    objective_.optimise(other, kFromNear, tick_);
    fill(other, static_cast<int>(count));
    if (other.residues.size() < count) continue;
    exchange(other, count - size);
    if (other.objective > form.objective * (1 - kGain)) continue;
    form = std::move(other);
    moved = true;
  }
  return moved;
}

// Scores all candidates for pole i with everything else as it is, and optimises the best ones.
bool PoleSearch::exchange(MeromorphicForm& form, Index i) {
  std::vector<int> others = form.poles;
  const Index size = orbit_size(form, i);
  const std::vector<int> own(others.begin() + i, others.begin() + i + size);
  others.erase(others.begin() + i, others.begin() + i + size);
  const std::vector<int> candidates = candidates_.for_move(form.poles[i], others);
  if (candidates.empty()) return false;
  const Index k = form.residues.size();
  objective_.prepare(with_images(candidates, options_.mirror), k, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = objective_.samples_of(form), now = thinned(A);
  scores_.set_rest(now - greens_.at(own, every_ * kThinning) * form.residues.segment(i, size),
                   median(now.cwiseAbs2().array()));
  objective_.prepare(form.poles, k, execution_);
  const MatrixXcd metric = objective_.jacobian_metric(A.cwiseAbs2().array(), k);
  std::vector<std::pair<double, int>> scores(candidates.size());
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int j) {
    std::vector<int> vertices = form.poles;
    vertices[i] = candidates[j];
    scores[j] = {scores_(candidates[j], form.residues[i]) + objective_.jacobian_term(vertices, form.residues, metric),
                 candidates[j]};
  });
  std::sort(scores.begin(), scores.end());
  std::vector<MeromorphicForm> tried;
  for (int j = 0; j < std::min<int>(kRefined, static_cast<int>(scores.size())); ++j) {
    tried.push_back(form);
    tried.back().poles[i] = scores[j].second;
    if (size == 2) tried.back().poles[i + 1] = options_.mirror->image[scores[j].second];
  }
  MeromorphicForm found = best_optimised(std::move(tried), kFromNear);
  if (found.objective > form.objective * (1 - kGain)) return false;
  form = std::move(found);
  return true;
}

// @param most poles, of which an orbit has one or two: what a pole gains is what counts
bool PoleSearch::add_one(MeromorphicForm& form, int most) {
  const std::size_t count = form.poles.size();
  std::vector<MeromorphicForm> tried;
  int left[] = {options_.mirror ? kTriedOnPlane : kTried, kTried};
  for (const Trial& trial : trials_everywhere(form)) {
    const bool pair = is_pair(trial.vertex);
    if ((pair && most < 2) || left[pair] == 0) continue;
    const bool known = std::any_of(tried.begin(), tried.end(),
                                   [&](const MeromorphicForm& p) { return p.poles[count] == trial.vertex; });
    if (known) continue;
    tried.push_back(joined(form, trial.vertex, trial.residue, basis_.closed(), options_.mirror));
    --left[pair];
  }
  if (tried.empty()) return false;
  std::vector<int> vertices = form.poles;
  for (const MeromorphicForm& each : tried)
    vertices.insert(vertices.end(), each.poles.begin() + count, each.poles.end());
  objective_.prepare(vertices, tried.front().residues.size(), execution_);
  tried = all_optimised(std::move(tried), kWithTrial);
  form = *std::ranges::min_element(tried, {}, [&](const MeromorphicForm& each) {
    return options_.mirror
               ? (each.objective - form.objective) / std::sqrt(static_cast<double>(each.poles.size() - count))
               : each.objective;
  });
  return true;
}

// All candidates with all trial residues beside the form as it is, the best first.
std::vector<PoleSearch::Trial> PoleSearch::trials_everywhere(const MeromorphicForm& form) {
  const std::vector<int> candidates = candidates_.everywhere(form.poles);
  greens_.solve_at(with_images(candidates, options_.mirror), execution_);
  scores_.prepare(candidates);
  const VectorXcd A = thinned(objective_.samples_of(form));
  scores_.set_rest(A, median(A.cwiseAbs2().array()));
  const double scale = std::sqrt(A.cwiseAbs2().mean() * basis_.area());
  const int phases = options_.kind == uv::Coefficients::real ? 2 : kTrialPhases;
  std::vector<Trial> trials;
  for (const int v : candidates) {
    for (const double size : kTrialSizes) {
      const int own = is_on_plane(v) ? 2 : phases;
      for (int j = 0; j < own; ++j) trials.push_back({0, v, std::polar(size * scale, 2 * std::numbers::pi * j / own)});
    }
  }
  run_throwing(execution_.workers(), static_cast<int>(trials.size()),
               [&](int j) { trials[j].value = scores_(trials[j].vertex, trials[j].residue); });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  return trials;
}

std::vector<MeromorphicForm> PoleSearch::all_optimised(std::vector<MeromorphicForm> list,
                                                       const std::vector<double>& floors) {
  run_long_tasks(execution_.workers(), static_cast<int>(list.size()),
                 [&](int thread, int i) { objective_.optimise(list[i], floors, [&] { watch_(thread); }); });
  return list;
}

MeromorphicForm PoleSearch::best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors) {
  list = all_optimised(std::move(list), floors);
  return *std::ranges::min_element(list, {}, &MeromorphicForm::objective);
}

}  // namespace holomorph::tiling
