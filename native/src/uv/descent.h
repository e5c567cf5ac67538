// The descent of the strain energy, on the whole surface or on a patch.
#pragma once

#include <deque>
#include <functional>

#include "base/workers.h"
#include "uv/strain_energy.h"

namespace holomorph::uv {

/// The second derivatives of the energy are about twice the Laplacian of StrainEnergy.
inline constexpr double kInverse = 0.5;

/// Applies an approximate inverse of the second derivatives, symmetric and positive.
using Precondition = std::function<Function(const Function& gradient)>;

/// A descent of StrainEnergy. While the energy falls quickly, each step of gradient descent makes its own
/// preconditioner. Later the last one serves several steps.
class Descent {
 public:
  /// @param make makes the preconditioner at delta. @param clear sets a function to 0 at its fixed vertices
  /// @pre the energy outlives this
  Descent(const StrainEnergy& energy, double lambda, std::function<Precondition(const Function& delta)> make,
          std::function<void(Function&)> clear, Workers& workers)
      : energy_(energy), lambda_(lambda), make_(std::move(make)), clear_(std::move(clear)), workers_(workers) {}

  /// Begins anew, also where the energy itself has changed.
  StrainEnergy::Value begin(Function delta);
  /// Makes one step. @return whether to go on: false near the minimum, where a step lowers the energy by little
  bool step();

  const Function& delta() const { return delta_; }
  const StrainEnergy::Value& value() const { return value_; }

 private:
  struct Step {
    Function step, change;  // what was added to delta, and by what that changed the gradient
    double curvature;       // their product
  };

  StrainEnergy::Value at(const Function& delta, Function& gradient);
  Function direction() const;
  void take(Function step, Function change);

  const StrainEnergy& energy_;
  const double lambda_;
  std::function<Precondition(const Function& delta)> make_;
  std::function<void(Function&)> clear_;
  Workers& workers_;

  Function delta_, gradient_, at_corners_;
  StrainEnergy::Value value_;
  Precondition precondition_;  // none: it is made before the next step
  bool was_short_ = false;     // the last step, and lowered the energy by little
  std::deque<Step> steps_;
};

}  // namespace holomorph::uv
