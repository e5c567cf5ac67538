#include "tiling/pole_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr int kThinning = 3;             // a third of the samples tells what is worth a trial
constexpr int kTried = 4, kRefined = 2;  // candidates that are optimised when a pole is added, and when one moves
constexpr int kRounds = 3, kSweeps = 5;
constexpr int kSpare = 4;       // so many more poles are placed, and taken away again
constexpr double kGain = 1e-3;  // less is no gain
// Residues that a new pole is tried with, relative to the root of mean density times area.
constexpr double kTrialSizes[] = {0.1, 0.3, 1.0};
constexpr int kTrialPhases = 6;
const std::vector<double> kFromAfar = {1.0, 0.1, 0.01, 1e-3, uv::kDensityFloor}, kFromNear = {uv::kDensityFloor},
                          kWithTrial = {0.03, uv::kDensityFloor};

VectorXcd thinned(const VectorXcd& samples) { return samples(Eigen::seq(0, Eigen::last, kThinning)); }

void rotate(Poles& poles) {
  std::rotate(poles.vertices.begin(), poles.vertices.begin() + 1, poles.vertices.end());
  std::rotate(poles.residues.begin(), poles.residues.begin() + 1, poles.residues.end());
}

std::vector<int> vertices_of(const std::vector<Poles>& list) {
  std::vector<int> all;
  for (const Poles& poles : list) all.insert(all.end(), poles.vertices.begin(), poles.vertices.end());
  return all;
}

}  // namespace

int least_count(const Landscape& landscape) { return landscape.form_count() > 0 ? 0 : landscape.closed() ? 2 : 1; }

PoleSearch::PoleSearch(Landscape& landscape, const PlacementRules& rules, int every, Execution& execution)
    : landscape_(landscape),
      rules_(rules),
      execution_(execution),
      candidates_(landscape, rules),
      every_(every),
      objective_(landscape, rules.kind, every) {}

Poles PoleSearch::begin() {
  Poles poles;
  poles.vertices = rules_.fixed;
  if (poles.vertices.empty() && landscape_.form_count() == 0) poles.vertices = candidates_.first();
  const auto k = static_cast<Index>(poles.vertices.size());
  poles.residues = VectorXcd::Ones(k);
  if (landscape_.closed() && k > 0) poles.residues[k - 1] = -static_cast<double>(k - 1);
  poles.coefficients = VectorXcd::Zero(landscape_.form_count());
  if (landscape_.form_count() > 0 && k == 0) {
    poles.coefficients = landscape_.form_count() == 1
                             ? VectorXcd::Ones(1)
                             : uv::lowest_variance(landscape_.surface(), landscape_.samples(), landscape_.holomorphic(),
                                                   rules_.kind, execution_.workers());
  }
  objective_.prepare(poles.vertices, execution_);
  objective_.optimise(poles, kFromAfar, execution_);
  return poles;
}

bool PoleSearch::add(Poles& poles, int count) {
  while (static_cast<int>(poles.vertices.size()) < count && add_one(poles)) {
  }
  return static_cast<int>(poles.vertices.size()) >= count;
}

bool PoleSearch::sweep(Poles& poles) {
  bool moved = false;
  for (Index i = 0; i < poles.residues.size(); ++i) {
    execution_.report(static_cast<double>(i) / static_cast<double>(poles.residues.size()));
    if (is_fixed(poles.vertices[i])) continue;
    moved |= exchange(poles, i);
  }
  return moved;
}

Poles PoleSearch::settled(Poles poles) {
  sweep_to_the_end(poles);
  for (int round = 1; round < kRounds && relocate(poles); ++round) sweep_to_the_end(poles);
  return poles;
}

Poles PoleSearch::pruned(Poles poles) {
  const std::size_t count = poles.vertices.size();
  Poles other = poles;
  add(other, static_cast<int>(count) + kSpare);
  sweep(other);
  while (other.vertices.size() > count) {
    std::vector<Poles> tried;
    for (std::size_t i = 0; i < other.vertices.size(); ++i) {
      rotate(other);  // each becomes the last one once
      if (!is_fixed(other.vertices.back())) tried.push_back(without_last(other));
    }
    other = best_optimised(std::move(tried), kFromNear);
  }
  sweep_to_the_end(other);
  const auto ratio = [&](const Poles& each) { return density_ratio(density(landscape_, each, execution_)); };
  return ratio(other) < ratio(poles) ? other : poles;
}

bool PoleSearch::is_fixed(int vertex) const {
  return std::find(rules_.fixed.begin(), rules_.fixed.end(), vertex) != rules_.fixed.end();
}

void PoleSearch::sweep_to_the_end(Poles& poles) {
  for (int i = 0; i < kSweeps && sweep(poles); ++i) execution_.report(static_cast<double>(i) / kSweeps);
}

// Takes each pole away and adds one where it does best, with a residue of its own. @return whether that was better
bool PoleSearch::relocate(Poles& poles) {
  const auto count = static_cast<Index>(poles.vertices.size());
  bool moved = false;
  for (Index i = 0; i < count && count > least_count(landscape_); ++i) {
    execution_.report(static_cast<double>(i) / static_cast<double>(count));
    rotate(poles);  // each becomes the last one once
    if (is_fixed(poles.vertices.back())) continue;
    Poles other = without_last(poles);
    objective_.optimise(other, kFromNear, execution_);
    if (!add_one(other)) continue;
    exchange(other, count - 1);
    if (other.variance > poles.variance * (1 - kGain)) continue;
    poles = std::move(other);
    moved = true;
  }
  return moved;
}

// Scores all candidates for pole i with everything else as it is, and optimises the best ones.
bool PoleSearch::exchange(Poles& poles, Index i) {
  std::vector<int> others = poles.vertices;
  others.erase(others.begin() + i);
  const std::vector<int> candidates = candidates_.for_move(poles.vertices[i], others);
  if (candidates.empty()) return false;
  const MatrixXcd green = landscape_.poles(candidates, execution_, every_ * kThinning);
  const VectorXcd A = objective_.form(poles, execution_);
  const VectorXcd without =
      thinned(A) - poles.residues[i] * landscape_.poles({poles.vertices[i]}, execution_, every_ * kThinning).col(0);
  objective_.prepare(candidates, execution_);
  objective_.prepare(poles.vertices, execution_);
  const MatrixXcd metric = objective_.leverage_metric(A.cwiseAbs2().array());
  std::vector<std::pair<double, int>> scores(candidates.size());
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int j) {
    std::vector<int> vertices = poles.vertices;
    vertices[i] = candidates[j];
    const Eigen::ArrayXd density = (without + poles.residues[i] * green.col(j)).cwiseAbs2().array();
    scores[j] = {unevenness(density) + objective_.leverage_term(vertices, poles.residues, metric), candidates[j]};
  });
  std::sort(scores.begin(), scores.end());
  std::vector<Poles> tried;
  for (int j = 0; j < std::min<int>(kRefined, static_cast<int>(scores.size())); ++j) {
    tried.push_back(poles);
    tried.back().vertices[i] = scores[j].second;
  }
  Poles found = best_optimised(std::move(tried), kFromNear);
  if (found.variance > poles.variance * (1 - kGain)) return false;
  poles = std::move(found);
  return true;
}

bool PoleSearch::add_one(Poles& poles) {
  std::vector<Poles> tried;
  for (const Trial& trial : trials_everywhere(poles)) {
    if (static_cast<int>(tried.size()) == kTried) break;
    const bool known =
        std::any_of(tried.begin(), tried.end(), [&](const Poles& p) { return p.vertices.back() == trial.vertex; });
    if (!known) tried.push_back(joined(poles, trial));
  }
  if (tried.empty()) return false;
  objective_.prepare(vertices_of(tried), execution_);
  poles = best_optimised(std::move(tried), kWithTrial);
  return true;
}

// The others share its residue on a closed surface.
Poles PoleSearch::without_last(Poles poles) const {
  const Index k = poles.residues.size() - 1;
  const Complex last = poles.residues[k];
  poles.vertices.pop_back();
  poles.residues.conservativeResize(k);
  if (landscape_.closed()) poles.residues.array() += last / static_cast<double>(k);
  return poles;
}

// With the trial's pole; the others share what it needs on a closed surface.
Poles PoleSearch::joined(const Poles& poles, const Trial& trial) const {
  Poles more = poles;
  const Index k = poles.residues.size();
  if (landscape_.closed() && k > 0) more.residues.array() -= trial.residue / static_cast<double>(k);
  more.vertices.push_back(trial.vertex);
  more.residues.conservativeResize(k + 1);
  more.residues[k] = landscape_.closed() && k == 0 ? 0 : trial.residue;
  return more;
}

// All candidates with all trial residues beside the form as it is, the best first.
std::vector<PoleSearch::Trial> PoleSearch::trials_everywhere(const Poles& poles) {
  const std::vector<int> candidates = candidates_.everywhere(poles.vertices);
  const MatrixXcd green = landscape_.poles(candidates, execution_, every_ * kThinning);
  const VectorXcd A = thinned(objective_.form(poles, execution_));
  const double scale = std::sqrt(A.cwiseAbs2().mean() * landscape_.area());
  const int phases = rules_.kind == uv::Coefficients::real ? 2 : kTrialPhases;
  std::vector<Trial> trials;
  for (const int v : candidates) {
    for (const double size : kTrialSizes) {
      for (int j = 0; j < phases; ++j)
        trials.push_back({0, v, std::polar(size * scale, 2 * std::numbers::pi * j / phases)});
    }
  }
  const int each = static_cast<int>(std::size(kTrialSizes)) * phases;
  run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int i) {
    for (int j = i * each; j < (i + 1) * each; ++j)
      trials[j].value = unevenness((A + trials[j].residue * green.col(i)).cwiseAbs2().array());
  });
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
  return trials;
}

Poles PoleSearch::best_optimised(std::vector<Poles> list, const std::vector<double>& floors) {
  run_throwing(execution_.workers(), static_cast<int>(list.size()),
               [&](int i) { objective_.optimise(list[i], floors, execution_); });
  return *std::min_element(list.begin(), list.end(),
                           [](const Poles& a, const Poles& b) { return a.variance < b.variance; });
}

}  // namespace holomorph::tiling
