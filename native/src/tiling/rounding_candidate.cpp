#include "tiling/rounding_candidate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/errors.h"
#include "base/task_progress.h"

namespace holomorph::tiling {
namespace {

// Limits of a pole's way, in square roots of the area; all are tried.
constexpr double kMoves[] = {0, 0.015, 0.04, 0.1};
constexpr double kFollowing = 0.1;  // the same limit for poles that follow another one
// With more handles than this poles do not move: so few poles can cancel the defects of few periods only. Where poles
// times handles exceed kMuch, they move for fewer roundings, in proportion.
constexpr int kMostHandles = 40;
constexpr std::size_t kMuch = 600;
constexpr double kUsualCandidates = 3000;
// Best roundings for each limit, which are measured again with the poles at their new places.
constexpr std::ptrdiff_t kWeighed = 3;

bool better(const Candidate& a, const Candidate& b) { return a.rounding.rank < b.rounding.rank; }

// The best few candidates for each limit of kMoves; candidate i had limit i % ways.
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

// The number of roundings for which poles are moved.
std::size_t movable(std::size_t roundings, const LiftedPoles& poles, const PoleBasis& basis) {
  const std::size_t work = poles.vertices.size() * static_cast<std::size_t>(basis.form_count());
  return work <= kMuch ? roundings : std::max<std::size_t>(1, roundings * kMuch / work);
}

// Residues of all poles from the free ones; closed, the last one is minus their sum.
VectorXcd all_residues(bool closed, std::size_t poles, const VectorXcd& free) {
  VectorXcd all(static_cast<Index>(poles));
  all.head(free.size()) = free;
  if (closed && poles > 0) all[free.size()] = -free.sum();
  return all;
}

// Upper R with |R t| the root mean square of the Beltrami coefficient.
MatrixXcd beltrami_metric(const RoundingProblem& problem) { return problem.defect_metric / std::sqrt(problem.tiles); }

// Sets X, the sum of `besides` = n + i m and of the periods that the residues need, and splits it into its holomorphic
// and its antiholomorphic part.
void set_periods(const VectorXcd& besides, const Jacobian& jacobian, Candidate& c) {
  c.X = besides;
  for (std::size_t i = 0; i < c.poles.parts.size(); ++i) c.X += c.residues[static_cast<Index>(i)] * c.poles.parts[i];
  const VectorXcd split = jacobian.split() * c.X;
  const Index g = split.size() / 2;
  c.rounding.y.head(g) = split.head(g);
  c.rounding.y.tail(g) = split.tail(g);
}

// Measures the rounding with the Green's functions at the present places of the poles.
void measure_at_poles(const RoundingProblem& problem, const GreensFunctions& greens, Candidate& c) {
  RoundingProblem there = problem;
  there.forms.middleCols(greens.basis().form_count(), problem.residues.rows()) = greens.pole_forms(c.poles.vertices);
  measure(there, c.rounding);
}

// Places poles at their new vertices. @return for each pole whether it was moved
std::vector<char> place_at(const Placement& placement, const std::vector<PoleMove>& moves, Candidate& candidate) {
  const PoleBasis& basis = *placement.basis;
  const std::vector<int>& labels = placement.options.labels;
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

// Lets the poles that were not moved by hand follow until the form is holomorphic again. Chosen poles stay.
void follow_by_inversion(const Placement& placement, const RoundingProblem& problem, const std::vector<char>& moved,
                         Candidate& c) {
  const JacobiInversion& inversion = *placement.inversion;
  // X = n + i m + sum r_i C_i. The lattice points n + i m stay, and every C_i follows its pole; of its values modulo
  // integers the nearest one continues the path.
  VectorXcd periods = c.X;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    VectorXd& part = c.poles.parts[i];
    periods -= c.residues[static_cast<Index>(i)] * part;
    if (moved[i]) part = nearest_representative(inversion.abel_jacobi.at(c.poles.vertices[i]), part);
  }
  const bool stay = placement.options.is_chosen();
  const MoveOptions options{placement.options.allowed, kFollowing, stay ? std::vector<char>(moved.size(), 1) : moved,
                            [] {}};
  c.poles = inversion.moved(std::move(c.poles), periods, c.residues, beltrami_metric(problem), options);
  set_periods(periods, inversion.jacobian, c);
}

// Updates the periods on a surface with boundary, where no pole follows.
void follow_with_boundary(const Placement& placement, const RoundingProblem& problem, Candidate& c,
                          Execution& execution) {
  const std::vector<Index> used = c.used();
  std::vector<int> vertices;
  for (const Index i : used) vertices.push_back(c.poles.vertices[i]);
  const auto maps = maps_at(placement, vertices, execution);
  VectorXcd change = VectorXcd::Zero(c.X.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    VectorXd& part = c.poles.parts[used[i]];
    const VectorXd before = part;
    part = nearest_representative(maps->pole_parts().col(static_cast<Index>(i)), before);
    change += c.residues[used[i]] * (part - before);
  }
  if (problem.kind == uv::Coefficients::real) change.imag().setZero();
  // X follows the C_i, so that n + i m stay the same.
  c.X += change;
  c.rounding.y.head(c.X.size()) = c.X;
  const Index defects = problem.defects.cols();
  const MatrixXd& star = placement.basis->structure().holomorphic().star.star;
  // t = Im(n + i m) - C#^T Re X (tiling.cpp).
  c.rounding.y.tail(defects) -= (star.transpose() * change.real()).head(defects);
}

}  // namespace

std::vector<Index> Candidate::used() const {
  std::vector<Index> indices;
  for (Index i = 0; i < residues.size(); ++i) {
    if (residues[i] != Complex(0)) indices.push_back(i);
  }
  return indices;
}

Candidate best_candidate(const Placement& placement, const RoundingProblem& problem, const std::vector<Rounding>& list,
                         const LiftedPoles& lifted, Execution& execution) {
  const PoleBasis& basis = *placement.basis;
  const JacobiInversion* inversion = placement.inversion.get();
  const bool moves =
      inversion && !placement.options.is_chosen() && problem.residues.rows() > 0 && basis.form_count() <= kMostHandles;
  const MatrixXcd metric = moves ? beltrami_metric(problem) : MatrixXcd();
  const int ways = moves ? static_cast<int>(std::size(kMoves)) : 1;
  std::vector<Candidate> candidates((moves ? movable(list.size(), lifted, basis) : list.size()) * ways);
  TaskProgress watch(execution, kUsualCandidates, static_cast<double>(problem.Z.size()));
  run_throwing(execution.workers(), static_cast<int>(candidates.size()), [&](int thread, int i) {
    watch(thread);
    Candidate& c = candidates[i];
    const Rounding& rounded = list[i / ways];
    const VectorXcd z = rounded.z.cast<double>().cast<Complex>(), periods = problem.periods * z;
    c = {rounded, lifted, all_residues(basis.closed(), lifted.vertices.size(), problem.residues * z),
         rounded.y.head(basis.form_count())};
    if (!inversion) return;
    if (const double farthest = kMoves[i % ways]; moves && farthest > 0)
      c.poles = inversion->moved(lifted, periods, c.residues, metric,
                                 {placement.options.allowed, farthest, {}, [&] { watch(thread); }});
    set_periods(periods, inversion->jacobian, c);
    // A first rank, with the density of the poles at their old places: that of the new ones costs a solve for each.
    measure(problem, c.rounding);
  });
  if (!moves) return held(std::ranges::min_element(candidates, better), candidates);
  candidates = best_of_each_way(candidates, ways);
  GreensFunctions greens = placement.greens;
  for (Candidate& c : candidates) {
    greens.solve_at(c.poles.vertices, execution);
    measure_at_poles(problem, greens, c);
  }
  return held(std::ranges::min_element(candidates, better), candidates);
}

Candidate with_poles_moved(const Placement& placement, const RoundingProblem& problem,
                           const std::vector<PoleMove>& moves, Candidate candidate, Execution& execution) {
  const std::vector<char> moved = place_at(placement, moves, candidate);
  if (placement.inversion)
    follow_by_inversion(placement, problem, moved, candidate);
  else if (placement.basis->form_count() > 0)
    follow_with_boundary(placement, problem, candidate, execution);
  GreensFunctions greens = placement.greens;
  greens.solve_at(candidate.poles.vertices, execution);
  measure_at_poles(problem, greens, candidate);
  return candidate;
}

}  // namespace holomorph::tiling
