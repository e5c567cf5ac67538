#include "tiling/candidate.h"

#include <algorithm>
#include <complex>

#include "base/chunks.h"
#include "tiling/tiling_problem.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double kMoves[] = {0, 0.015, 0.04, 0.1};  // how far poles may go, in square roots of the area: each is tried
constexpr std::ptrdiff_t kWeighed = 3;  // roundings for each, whose density is found with the poles where they are

bool better(const Candidate& a, const Candidate& b) { return a.rounding.rank < b.rounding.rank; }

// The best few of each way; candidate i went way i % ways.
std::vector<Candidate> best_of_each_way(const std::vector<Candidate>& candidates, int ways) {
  std::vector<Candidate> kept;
  for (int way = 0; way < ways; ++way) {
    std::vector<Candidate> order;
    for (std::size_t i = way; i < candidates.size(); i += ways) order.push_back(candidates[i]);
    std::stable_sort(order.begin(), order.end(), better);
    kept.insert(kept.end(), order.begin(), order.begin() + std::min<std::ptrdiff_t>(std::ssize(order), kWeighed));
  }
  return kept;
}

// With the periods as rounded and the poles where they now are, what is left over.
void split_periods(const RoundingProblem& problem, const Leverage& leverage, Index forms, Candidate& candidate) {
  candidate.X = problem.periods * candidate.rounding.z.cast<double>().cast<Complex>();
  for (std::size_t i = 0; i < candidate.poles.parts.size(); ++i)
    candidate.X += candidate.residues[static_cast<Index>(i)] * candidate.poles.parts[i];
  const VectorXcd split = leverage.split(candidate.X);
  candidate.rounding.y.head(forms) = split.head(forms);
  candidate.rounding.y.tail(forms) = split.tail(forms);
  measure(problem, candidate.rounding);
}

}  // namespace

std::vector<Index> Candidate::used() const {
  std::vector<Index> indices;
  for (Index i = 0; i < residues.size(); ++i) {
    if (residues[i] != Complex(0)) indices.push_back(i);
  }
  return indices;
}

Candidate best_candidate(const RoundingProblem& problem, const std::vector<Rounding>& list, const PlacedPoles& placed,
                         const Mobility& mobility, double tiles, Landscape& landscape, Execution& execution) {
  const Index n = landscape.form_count(), k = problem.residues.rows();
  const bool moves = mobility.pole_moves && mobility.movable && k > 0;
  const MatrixXcd metric = moves ? MatrixXcd(defect_metric(problem) / std::sqrt(tiles)) : MatrixXcd();
  const int ways = moves ? static_cast<int>(std::size(kMoves)) : 1;
  std::vector<Candidate> candidates(list.size() * ways);
  run_throwing(execution.workers(), static_cast<int>(candidates.size()), [&](int i) {
    Candidate& c = candidates[i];
    const Rounding& rounded = list[i / ways];
    const VectorXcd z = rounded.z.cast<double>().cast<Complex>();
    c = {rounded, placed, all_residues(landscape, placed.vertices.size(), problem.residues * z), rounded.y.head(n)};
    if (!mobility.pole_moves) return;
    if (moves && kMoves[i % ways] > 0) {
      c.poles = mobility.pole_moves->moved(placed, problem.periods * z, c.residues, metric,
                                           {mobility.allowed, kMoves[i % ways], {}});
    }
    split_periods(problem, mobility.pole_moves->leverage(), n, c);
  });
  if (!moves) return *std::min_element(candidates.begin(), candidates.end(), better);
  candidates = best_of_each_way(candidates, ways);
  for (Candidate& c : candidates) {
    RoundingProblem there = problem;
    there.forms.middleCols(n, k) = pole_forms(landscape, c.poles.vertices, execution);
    measure(there, c.rounding);
  }
  return *std::min_element(candidates.begin(), candidates.end(), better);
}

}  // namespace holomorph::tiling
