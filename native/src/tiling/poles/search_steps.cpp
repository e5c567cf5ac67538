#include "tiling/poles/search_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "base/held.h"

namespace holomorph::tiling {
namespace {

// Candidates that are optimised: when a pole is added, or hidden, and when it moves.
constexpr int kTried = 4, kRefined = 2;
// Sizes of residues that a new pole is tried with, relative to the root of mean density times area.
constexpr double kTrialSizes[] = {0.1, 0.3, 1.0};
constexpr int kTrialPhases = 6;
const std::vector<double> kWithTrial = {0.03, uv::kDensityFloor};

constexpr int kThinning = 3;           // a third of the samples is enough to choose what is tried
constexpr double kUsualValues = 3000;  // usual evaluations of the objective in a search
constexpr double kOperations = 1.5;    // of an evaluation, for each sample and form

VectorXcd thinned(const VectorXcd& samples) { return samples(Eigen::seq(0, Eigen::last, kThinning)); }

// Adds a pole; the others share the opposite of its residue where the sum has to be 0.
MeromorphicForm joined(MeromorphicForm form, int vertex, Complex residue, bool closed) {
  const Index k = form.residues.size();
  if (closed && k > 0) form.residues.array() -= residue / static_cast<double>(k);
  form.poles.push_back(vertex);
  form.residues.conservativeResize(k + 1);
  form.residues[k] = closed && k == 0 ? 0 : residue;
  return form;
}

}  // namespace

SearchSteps::SearchSteps(GreensFunctions& greens, const PlaceOptions& options, int every, Execution& execution)
    : greens_(greens),
      basis_(greens.basis()),
      options_(options),
      execution_(execution),
      candidates_(basis_, options),
      objective_(greens, options.kind, every),
      watch_(execution, kUsualValues, kOperations * static_cast<double>(basis_.holomorphic().M.size()) / every),
      every_(every),
      scores_(greens, every * kThinning) {}

void SearchSteps::begin_hiding(const std::vector<int>& poles, double worth, double share) {
  exposure_.emplace(basis_.surface());
  exposure_->prepare(poles, execution_.workers());
  weight_ = worth;
  share_ = share;
}

// The objective; while poles are hidden, with their weighted exposure, and infinite if it has grown too much.
double SearchSteps::price(const MeromorphicForm& form) const {
  if (!exposure_) return form.objective;
  if (form.objective > limit_) return INFINITY;
  double seen = 0;
  for (const int v : form.poles) seen += (*exposure_)(v);
  return form.objective + weight_ * seen / static_cast<double>(form.poles.size());
}

// Scores all candidates for pole i, with residues and coefficients as they are, and optimises the best ones.
bool SearchSteps::exchange(MeromorphicForm& form, Index i) {
  std::vector<int> others = form.poles;
  others.erase(others.begin() + i);
  const std::vector<int> candidates = candidates_.for_move(form.poles[i], others);
  if (candidates.empty()) return false;
  limit_ = form.objective + share_;
  if (exposure_) exposure_->prepare(candidates, execution_.workers());
  const Index k = form.residues.size();
  objective_.prepare(candidates, k, execution_);
  scores_.prepare(candidates);
  const VectorXcd A = objective_.samples_of(form), now = thinned(A);
  // The form without the pole that moves is common to all candidates.
  scores_.set_rest(now - greens_.at({form.poles[i]}, every_ * kThinning) * form.residues.segment(i, 1),
                   median(now.cwiseAbs2().array()));
  objective_.prepare(form.poles, k, execution_);
  const MatrixXcd metric = objective_.jacobian_metric(A.cwiseAbs2().array(), k);
  std::vector<std::pair<double, int>> scores(candidates.size());
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int j) {
    std::vector<int> vertices = form.poles;
    vertices[i] = candidates[j];
    const int v = candidates[j];
    const double seen = exposure_ ? weight_ * (*exposure_)(v) / static_cast<double>(k) : 0;
    scores[j] = {scores_(v, form.residues[i]) + objective_.jacobian_term(vertices, form.residues, metric) + seen, v};
  });
  std::sort(scores.begin(), scores.end());
  std::vector<MeromorphicForm> tried;
  for (int j = 0; j < std::min<int>(exposure_ ? kTried : kRefined, static_cast<int>(scores.size())); ++j) {
    tried.push_back(form);
    tried.back().poles[i] = scores[j].second;
  }
  MeromorphicForm found = best_optimised(std::move(tried), kFromNear);
  if (price(found) > price(form) * (1 - kGain)) return false;
  form = std::move(found);
  return true;
}

// Tries the best-scored places and residues.
bool SearchSteps::add_one(MeromorphicForm& form) {
  const std::size_t count = form.poles.size();
  std::vector<MeromorphicForm> tried;
  for (const Trial& trial : trials_everywhere(form)) {
    if (std::ssize(tried) == kTried) break;
    const bool known = std::any_of(tried.begin(), tried.end(),
                                   [&](const MeromorphicForm& p) { return p.poles[count] == trial.vertex; });
    if (known) continue;
    tried.push_back(joined(form, trial.vertex, trial.residue, basis_.closed()));
  }
  if (tried.empty()) return false;
  std::vector<int> vertices = form.poles;
  for (const MeromorphicForm& each : tried) vertices.push_back(each.poles[count]);
  objective_.prepare(vertices, tried.front().residues.size(), execution_);
  tried = all_optimised(std::move(tried), kWithTrial);
  form = *std::ranges::min_element(tried, {}, &MeromorphicForm::objective);
  return true;
}

// Scores all candidates with all trial residues, the form as it is, and returns them the best first.
std::vector<SearchSteps::Trial> SearchSteps::trials_everywhere(const MeromorphicForm& form) {
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
  run_throwing(execution_.workers(), static_cast<int>(trials.size()),
               [&](int j) { trials[j].value = scores_(trials[j].vertex, trials[j].residue); });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  return trials;
}

std::vector<MeromorphicForm> SearchSteps::all_optimised(std::vector<MeromorphicForm> list,
                                                        const std::vector<double>& floors) {
  run_long_tasks(execution_.workers(), static_cast<int>(list.size()),
                 [&](int thread, int i) { objective_.optimise(list[i], floors, [&] { watch_(thread); }); });
  return list;
}

MeromorphicForm SearchSteps::best_optimised(std::vector<MeromorphicForm> list, const std::vector<double>& floors) {
  list = all_optimised(std::move(list), floors);
  return held(std::ranges::min_element(list, {}, [&](const MeromorphicForm& form) { return price(form); }), list);
}

}  // namespace holomorph::tiling
