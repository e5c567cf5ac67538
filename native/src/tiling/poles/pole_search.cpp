#include "tiling/poles/pole_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

constexpr int kThinning = 3;             // a third of the samples tells what is worth a trial
constexpr int kTried = 4, kRefined = 2;  // candidates that are optimised when a pole is added, and when one moves
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

void rotate(MeromorphicForm& form) {
  std::rotate(form.poles.begin(), form.poles.begin() + 1, form.poles.end());
  std::rotate(form.residues.begin(), form.residues.begin() + 1, form.residues.end());
}

}  // namespace

int least_count(const PoleBasis& basis) { return basis.form_count() > 0 ? 0 : basis.closed() ? 2 : 1; }

PoleSearch::PoleSearch(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution)
    : greens_(greens),
      basis_(greens.basis()),
      options_(options),
      execution_(execution),
      candidates_(basis_, options),
      every_(every),
      objective_(greens, options.kind, every),
      scores_(greens, every * kThinning),
      watch_(execution, kUsualValues) {}

MeromorphicForm PoleSearch::begin() {
  MeromorphicForm form;
  form.poles = options_.fixed;
  if (form.poles.empty() && basis_.form_count() == 0) form.poles = candidates_.first();
  const auto k = static_cast<Index>(form.poles.size());
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
  return form;
}

bool PoleSearch::add(MeromorphicForm& form, int count) {
  while (static_cast<int>(form.poles.size()) < count && add_one(form)) {
  }
  refit(form);
  return static_cast<int>(form.poles.size()) >= count;
}

bool PoleSearch::sweep(MeromorphicForm& form) {
  bool moved = false;
  for (Index i = 0; i < form.residues.size(); ++i) {
    if (is_fixed(form.poles[i])) continue;
    moved |= exchange(form, i);
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
    for (std::size_t i = 0; i < other.poles.size(); ++i) {
      rotate(other);  // each becomes the last one once
      if (!is_fixed(other.poles.back())) tried.push_back(without_last(other));
    }
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

bool PoleSearch::is_fixed(int vertex) const {
  return std::find(options_.fixed.begin(), options_.fixed.end(), vertex) != options_.fixed.end();
}

// Until every pole has stayed where it is beside the others as they are.
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

// Takes each pole away and adds one where it does best, with a residue of its own. @return whether that was better
bool PoleSearch::relocate(MeromorphicForm& form) {
  const auto count = static_cast<Index>(form.poles.size());
  bool moved = false;
  for (Index i = 0; i < count && count > least_count(basis_); ++i) {
    rotate(form);  // each becomes the last one once
    if (is_fixed(form.poles.back())) continue;
    MeromorphicForm other = without_last(form);
    objective_.optimise(other, kFromNear, tick_);
    if (!add_one(other)) continue;
    exchange(other, count - 1);
    if (other.objective > form.objective * (1 - kGain)) continue;
    form = std::move(other);
    moved = true;
  }
  return moved;
}

// Scores all candidates for pole i with everything else as it is, and optimises the best ones.
bool PoleSearch::exchange(MeromorphicForm& form, Index i) {
  std::vector<int> others = form.poles;
  others.erase(others.begin() + i);
  const std::vector<int> candidates = candidates_.for_move(form.poles[i], others);
  if (candidates.empty()) return false;
  const Index k = form.residues.size();
  objective_.prepare(candidates, k, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = objective_.samples_of(form), now = thinned(A);
  scores_.set_rest(now - form.residues[i] * greens_.at({form.poles[i]}, every_ * kThinning).col(0),
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
  }
  MeromorphicForm found = best_optimised(std::move(tried), kFromNear);
  if (found.objective > form.objective * (1 - kGain)) return false;
  form = std::move(found);
  return true;
}

bool PoleSearch::add_one(MeromorphicForm& form) {
  std::vector<MeromorphicForm> tried;
  for (const Trial& trial : trials_everywhere(form)) {
    if (static_cast<int>(tried.size()) == kTried) break;
    const bool known = std::any_of(tried.begin(), tried.end(),
                                   [&](const MeromorphicForm& p) { return p.poles.back() == trial.vertex; });
    if (!known) tried.push_back(joined(form, trial));
  }
  if (tried.empty()) return false;
  std::vector<int> vertices = form.poles;
  for (const MeromorphicForm& each : tried) vertices.push_back(each.poles.back());
  objective_.prepare(vertices, tried.front().residues.size(), execution_);
  form = best_optimised(std::move(tried), kWithTrial);
  return true;
}

// The others share its residue on a closed surface.
MeromorphicForm PoleSearch::without_last(MeromorphicForm form) const {
  const Index k = form.residues.size() - 1;
  const Complex last = form.residues[k];
  form.poles.pop_back();
  form.residues.conservativeResize(k);
  if (basis_.closed()) form.residues.array() += last / static_cast<double>(k);
  return form;
}

// With the trial's pole; the others share what it needs on a closed surface.
MeromorphicForm PoleSearch::joined(const MeromorphicForm& form, const Trial& trial) const {
  MeromorphicForm more = form;
  const Index k = form.residues.size();
  if (basis_.closed() && k > 0) more.residues.array() -= trial.residue / static_cast<double>(k);
  more.poles.push_back(trial.vertex);
  more.residues.conservativeResize(k + 1);
  more.residues[k] = basis_.closed() && k == 0 ? 0 : trial.residue;
  return more;
}

// All candidates with all trial residues beside the form as it is, the best first.
std::vector<PoleSearch::Trial> PoleSearch::trials_everywhere(const MeromorphicForm& form) {
  const std::vector<int> candidates = candidates_.everywhere(form.poles);
  greens_.solve_at(candidates, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = thinned(objective_.samples_of(form));
  scores_.set_rest(A, median(A.cwiseAbs2().array()));
  const double scale = std::sqrt(A.cwiseAbs2().mean() * basis_.area());
  const int phases = options_.kind == uv::Coefficients::real ? 2 : kTrialPhases;
  std::vector<Trial> trials;
  for (const int v : candidates) {
    for (const double size : kTrialSizes) {
      for (int j = 0; j < phases; ++j)
        trials.push_back({0, v, std::polar(size * scale, 2 * std::numbers::pi * j / phases)});
    }
  }
  const int each = static_cast<int>(std::size(kTrialSizes)) * phases;
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int i) {
    for (int j = i * each; j < (i + 1) * each; ++j) trials[j].value = scores_(trials[j].vertex, trials[j].residue);
  });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  return trials;
}

MeromorphicForm PoleSearch::best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors) {
  run_long_tasks(execution_.workers(), static_cast<int>(list.size()),
                 [&](int thread, int i) { objective_.optimise(list[i], floors, [&] { watch_(thread); }); });
  return *std::ranges::min_element(list, {}, &MeromorphicForm::objective);
}

}  // namespace holomorph::tiling
