#include "uv/turned_functions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/workers.h"

namespace holomorph::uv {
namespace {

constexpr std::size_t kMemory = 6;  // steps
constexpr double kProgress = 3e-3;  // the descent ends at a step that lowers the energy by less than this part of it
constexpr double kFar = 0.03;       // after a step that lowers it by more, the preconditioner is made anew
constexpr double kDecrease = 1e-4;  // Armijo's condition: least part of the decrease along the slope
constexpr double kShortest = 1e-6;  // shortest step, relative to the full one

// The inner product: the sum of the products of u and of v.
double product(const Function& a, const Function& b, Workers& workers) {
  return sum_over_rows(workers, static_cast<int>(a.size()), 0.0,
                       [&](int v, double& sum) { sum += a[v].real() * b[v].real() + a[v].imag() * b[v].imag(); });
}

// a += factor b
void add(Function& a, double factor, const Function& b, Workers& workers) {
  for_rows(workers, static_cast<int>(a.size()), [&](int v) { a[v] += factor * b[v]; });
}

// Calls body(edge, a, b, turn) once for each edge: a function at vertex a is that at b, times the turn.
template <class Body>
void for_edges(const mesh::Surface& surface, const Kept& kept, const Body& body) {
  std::vector<char> done(surface.edges.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int edge = surface.triangle_edges[t][i], j = (i + 1) % 3;
      if (done[edge]) continue;
      done[edge] = 1;
      body(edge, surface.triangles[t][i], surface.triangles[t][j], std::conj(kept.turns[t][i]) * kept.turns[t][j]);
    }
  }
}

}  // namespace

StrainEnergy::Value Descent::begin(Function delta) {
  delta_ = std::move(delta);
  precondition_ = nullptr;
  was_short_ = false;
  return value_ = at(delta_, gradient_);
}

StrainEnergy::Value Descent::at(const Function& delta, Function& gradient) {
  const StrainEnergy::Value value = energy_(delta, lambda_, gradient, at_corners_, workers_);
  clear_(gradient);
  return value;
}

bool Descent::step() {
  if (!precondition_) {
    // A new preconditioner knows the second derivatives at delta, so the history of older steps is dropped.
    steps_.clear();
    precondition_ = make_(delta_);
  }
  Function along = direction(), next, next_gradient;
  const double slope = product(gradient_, along, workers_);
  if (!(slope < 0)) return false;
  StrainEnergy::Value next_value;
  double length = 1;
  for (;; length /= 2) {
    if (!(length > kShortest)) return false;
    next = delta_;
    add(next, length, along, workers_);
    next_value = at(next, next_gradient);
    // Armijo's condition. The energy is finite for flipped triangles, too, so the step need not stop before them.
    if (next_value.energy <= value_.energy + kDecrease * length * slope) break;
  }
  for_rows(workers_, static_cast<int>(along.size()), [&](int v) {
    along[v] *= length;
    gradient_[v] = next_gradient[v] - gradient_[v];
  });
  take(std::move(along), std::move(gradient_));
  const double progress = (value_.energy - next_value.energy) / value_.energy;
  delta_ = std::move(next);
  gradient_ = std::move(next_gradient);
  value_ = next_value;
  const bool is_worth_it = progress > kProgress;
  // A step that had to be shortened does not say that the minimum is near: one more follows, with a new preconditioner.
  was_short_ = !is_worth_it && length < 1 && !was_short_;
  if (progress > kFar || was_short_) precondition_ = nullptr;
  return is_worth_it || was_short_;
}

Function Descent::direction() const {
  // The two-loop recursion of L-BFGS, with the preconditioner for the inverse second derivatives to begin with.
  Function result = gradient_;
  std::vector<double> along(steps_.size());
  for (std::size_t k = steps_.size(); k-- > 0;) {
    along[k] = product(steps_[k].step, result, workers_) / steps_[k].curvature;
    add(result, -along[k], steps_[k].change, workers_);
  }
  result = precondition_(result);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double across = product(steps_[k].change, result, workers_) / steps_[k].curvature;
    add(result, along[k] - across, steps_[k].step, workers_);
  }
  clear_(result);
  for_rows(workers_, static_cast<int>(result.size()), [&](int v) { result[v] = -result[v]; });
  return result;
}

// Remembers a step. One along which the gradient falls is left out: with it the inverse would not be positive.
void Descent::take(Function step, Function change) {
  const double curvature = product(step, change, workers_);
  if (!(curvature > 0)) return;
  if (steps_.size() == kMemory) steps_.pop_front();
  steps_.push_back({std::move(step), std::move(change), curvature});
}

void TurnedSolver::make(const Array<double>& edge_weights) {
  if (is_diagonal_) {
    Function sums(surface_.vertex_count, 0.0);
    for (std::size_t e = 0; e < surface_.edges.size(); ++e) {
      for (const int v : surface_.edges[e]) sums[v] += Complex(edge_weights[e], edge_weights[e]);
    }
    diagonal_ = kept_.unknowns.gathered(sums).cwiseAbs();
    return;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for_edges(surface_, kept_, [&](int edge, int a, int b, Complex turn) {
    kept_.unknowns.add_difference(a, b, edge_weights[edge], turn, entries);
  });
  Eigen::SparseMatrix<double> lower(kept_.unknowns.count, kept_.unknowns.count);
  lower.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(lower, {});
}

Function TurnedSolver::precondition(const Function& gradient) {
  const Eigen::VectorXd b = kept_.unknowns.gathered(gradient);
  if (is_diagonal_) return kept_.unknowns.spread(kInverse * b.cwiseQuotient(diagonal_));
  return kept_.unknowns.spread(kInverse * factor_.solve(Eigen::MatrixXd(b)).col(0));
}

void Unknowns::add(int p, int q, double value, std::vector<Eigen::Triplet<double>>& entries) const {
  const int a = number[p], b = number[q];
  if (a < 0 || b < 0 || value == 0) return;
  const double signed_value = sign[p] * sign[q] * value;
  if (a == b)
    entries.emplace_back(a, a, p == q ? signed_value : 2 * signed_value);
  else
    entries.emplace_back(std::max(a, b), std::min(a, b), signed_value);
}

void Unknowns::add_difference(int a, int b, double weight, Complex turn,
                              std::vector<Eigen::Triplet<double>>& entries) const {
  for (const int part : {0, 1}) {
    add(2 * a + part, 2 * a + part, weight, entries);
    add(2 * b + part, 2 * b + part, weight, entries);
    if (a != b) add(2 * a + part, 2 * b + part, -weight * turn.real(), entries);
  }
  if (a == b) return;
  add(2 * a, 2 * b + 1, weight * turn.imag(), entries);
  add(2 * a + 1, 2 * b, -weight * turn.imag(), entries);
}

Function Unknowns::spread(const Eigen::VectorXd& x) const {
  Function function(number.size() / 2, 0.0);
  for (std::size_t v = 0; v < function.size(); ++v) {
    const auto part = [&](std::size_t p) { return number[p] < 0 ? 0.0 : sign[p] * x[number[p]]; };
    function[v] = {part(2 * v), part(2 * v + 1)};
  }
  return function;
}

Eigen::VectorXd Unknowns::gathered(const Function& function) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count);
  for (std::size_t v = 0; v < function.size(); ++v) {
    const double parts[2] = {function[v].real(), function[v].imag()};
    for (std::size_t i = 0; i < 2; ++i) {
      if (number[2 * v + i] >= 0) x[number[2 * v + i]] += sign[2 * v + i] * parts[i];
    }
  }
  return x;
}

std::vector<char> Unknowns::shared() const {
  std::vector<int> parts(count, 0);
  for (const int n : number) {
    if (n >= 0) ++parts[n];
  }
  std::vector<char> result(number.size(), 0);
  for (std::size_t p = 0; p < number.size(); ++p) result[p] = number[p] >= 0 && parts[number[p]] > 1;
  return result;
}

}  // namespace holomorph::uv
