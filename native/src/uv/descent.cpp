#include "uv/descent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/chunks.h"

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

}  // namespace holomorph::uv
