#include "tiling/inversion/candidate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/chunks.h"
#include "base/errors.h"

namespace holomorph::tiling {
namespace {

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

// Residues of all poles from the free ones; closed, the last one is minus their sum.
VectorXcd all_residues(bool closed, std::size_t poles, const VectorXcd& free) {
  VectorXcd all(static_cast<Index>(poles));
  all.head(free.size()) = free;
  if (closed && poles > 0) all[free.size()] = -free.sum();
  return all;
}

}  // namespace

std::vector<Index> Candidate::used() const {
  std::vector<Index> indices;
  for (Index i = 0; i < residues.size(); ++i) {
    if (residues[i] != Complex(0)) indices.push_back(i);
  }
  return indices;
}

void set_periods(const VectorXcd& besides, const Jacobian& jacobian, Candidate& c) {
  c.X = besides;
  for (std::size_t i = 0; i < c.poles.parts.size(); ++i) c.X += c.residues[static_cast<Index>(i)] * c.poles.parts[i];
  const VectorXcd split = jacobian.split() * c.X;
  const Index g = split.size() / 2;
  c.rounding.y.head(g) = split.head(g);
  c.rounding.y.tail(g) = split.tail(g);
}

void measure(const RoundingProblem& problem, const GreensFunctions& greens, Candidate& c) {
  RoundingProblem there = problem;
  there.forms.middleCols(greens.basis().form_count(), problem.residues.rows()) = greens.pole_forms(c.poles.vertices);
  measure(there, c.rounding);
}

Candidate best_candidate(const RoundingProblem& problem, const std::vector<Rounding>& list, const LiftedPoles& placed,
                         const Mobility& mobility, double tiles, GreensFunctions greens, Execution& execution) {
  const PoleBasis& basis = greens.basis();
  const JacobiInversion* inversion = mobility.inversion;
  const bool moves = inversion && mobility.movable && problem.residues.rows() > 0;
  const MatrixXcd metric = moves ? MatrixXcd(defect_metric(problem) / std::sqrt(tiles)) : MatrixXcd();
  const int ways = moves ? static_cast<int>(std::size(kMoves)) : 1;
  std::vector<Candidate> candidates(list.size() * ways);
  run_throwing(execution.workers(), static_cast<int>(candidates.size()), [&](int i) {
    Candidate& c = candidates[i];
    const Rounding& rounded = list[i / ways];
    const VectorXcd z = rounded.z.cast<double>().cast<Complex>(), periods = problem.periods * z;
    c = {rounded, placed, all_residues(basis.closed(), placed.vertices.size(), problem.residues * z),
         rounded.y.head(basis.form_count())};
    if (!inversion) return;
    if (const double farthest = kMoves[i % ways]; moves && farthest > 0)
      c.poles = inversion->moved(placed, periods, c.residues, metric, {mobility.allowed, farthest, {}});
    set_periods(periods, inversion->jacobian, c);
    measure(problem, c.rounding);
  });
  if (!moves) return *std::min_element(candidates.begin(), candidates.end(), better);
  candidates = best_of_each_way(candidates, ways);
  for (Candidate& c : candidates) {
    greens.solve_at(c.poles.vertices, execution);
    measure(problem, greens, c);
  }
  return *std::min_element(candidates.begin(), candidates.end(), better);
}

std::vector<char> place_at(const std::vector<PoleMove>& moves, const PoleBasis& basis, const std::vector<int>& labels,
                           Candidate& candidate) {
  const std::vector<Index> used = candidate.used();
  std::vector<char> moved(candidate.poles.vertices.size(), 0);
  for (const auto& [i, v] : moves) {
    if (i < 0 || i >= static_cast<int>(used.size()))
      throw TopologyError("there is no pole " + std::to_string(i) + ": the tiling has " + std::to_string(used.size()));
    if (!mesh::has_proper_star(basis.surface(), basis.half_edges(), v))
      throw TopologyError("vertex " + std::to_string(labels.empty() ? v : labels[v]) +
                          " cannot be a pole: its faces touch the boundary or themselves");
    moved[used[i]] = 1;
    candidate.poles.vertices[used[i]] = v;
  }
  return moved;
}

void follow_by_inversion(const JacobiInversion& inversion, const MatrixXcd& metric, const MoveOptions& options,
                         const std::vector<char>& moved, Candidate& c) {
  VectorXcd periods = c.X;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    VectorXd& part = c.poles.parts[i];
    periods -= c.residues[static_cast<Index>(i)] * part;
    if (moved[i]) part = nearest_representative(inversion.abel_jacobi.at(c.poles.vertices[i]), part);
  }
  c.poles = inversion.moved(std::move(c.poles), periods, c.residues, metric, options);
  set_periods(periods, inversion.jacobian, c);
}

void follow_with_boundary(const PoleBasis& basis, const RoundingProblem& problem, const MatrixXd& parts, Candidate& c) {
  VectorXcd change = VectorXcd::Zero(parts.rows());
  const std::vector<Index> used = c.used();
  for (std::size_t i = 0; i < used.size(); ++i) {
    VectorXd& part = c.poles.parts[used[i]];
    const VectorXd before = part;
    part = nearest_representative(parts.col(static_cast<Index>(i)), before);
    change += c.residues[used[i]] * (part - before);
  }
  if (problem.kind == uv::Coefficients::real) change.imag().setZero();
  c.X += change;
  c.rounding.y.head(c.X.size()) = c.X;
  const Index defects = problem.defects.cols();
  c.rounding.y.tail(defects) -= (basis.structure().holomorphic().star.star.transpose() * change.real()).head(defects);
}

}  // namespace holomorph::tiling
