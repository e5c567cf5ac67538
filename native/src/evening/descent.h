// Limited-memory BFGS with a preconditioner (Nocedal & Wright, Numerical Optimization, algorithm 7.4), for functions on
// the vertices of a surface.
#pragma once

#include <deque>

#include "base/workers.h"
#include "evening/strain_energy.h"

namespace holomorph::evening {

/// The last steps of a descent, and what they say of the inverse second derivatives.
class Descent {
 public:
  /// @param precondition Function(const Function&), symmetric and positive
  /// @return the direction to go, given the gradient
  template <class Precondition>
  Function direction(const Function& gradient, const Precondition& precondition, Workers& workers) const {
    Function result = gradient;
    std::vector<double> along(steps_.size());
    for (std::size_t k = steps_.size(); k-- > 0;) {
      along[k] = product(steps_[k].step, result, workers) / steps_[k].curvature;
      add(result, -along[k], steps_[k].change, workers);
    }
    result = precondition(result);
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const double across = product(steps_[k].change, result, workers) / steps_[k].curvature;
      add(result, along[k] - across, steps_[k].step, workers);
    }
    for_rows(workers, static_cast<int>(result.size()), [&](int v) { result[v] = -result[v]; });
    return result;
  }

  /// Takes a step and the change of the gradient along it. Steps along which the gradient falls say nothing.
  void take(Function step, Function change, Workers& workers);

  /// Sum of the products of u and of v.
  static double product(const Function& a, const Function& b, Workers& workers);
  /// a += factor b
  static void add(Function& a, double factor, const Function& b, Workers& workers);

 private:
  struct Step {
    Function step, change;
    double curvature;  // their product
  };
  std::deque<Step> steps_;
};

}  // namespace holomorph::evening
