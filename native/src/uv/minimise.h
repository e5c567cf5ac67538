// A small unconstrained minimiser: BFGS with backtracking (Nocedal & Wright 2006, algorithm 6.1,
// doi:10.1007/978-0-387-40065-5).
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace holomorph::uv {

/// When to stop.
struct Minimising {
  int most_steps = 200;
  double progress = 1e-9;   ///< stops after a step that lowers the value by less than this part of it
  double shortest = 1e-12;  ///< step, relative to the full one
};

/// @param objective double(const VectorXd& x, VectorXd& gradient)
/// Minimises a function of a few variables. @param x start in, minimum out. @return the least value
/// @param H an inverse Hessian to begin with; empty: none is known
template <class Objective>
double minimise(const Objective& objective, Eigen::VectorXd& x, const Minimising& until, Eigen::MatrixXd H = {}) {
  constexpr double kDecrease = 1e-4;  // Armijo
  const auto n = x.size();
  Eigen::VectorXd gradient, new_gradient;
  double value = objective(x, gradient);
  if (H.size() == 0) H = Eigen::MatrixXd::Identity(n, n) * (x.norm() / std::max(gradient.norm(), 1e-300));
  for (int step = 0; step < until.most_steps; ++step) {
    Eigen::VectorXd direction = -(H * gradient);
    double slope = gradient.dot(direction);
    if (!(slope < 0)) {
      H.setIdentity();
      direction = -gradient;
      slope = -gradient.squaredNorm();
      if (!(slope < 0)) break;
    }
    double length = 1, new_value = INFINITY;
    Eigen::VectorXd candidate;
    for (; length > until.shortest; length /= 2) {
      candidate = x + length * direction;
      new_value = objective(candidate, new_gradient);
      if (new_value <= value + kDecrease * length * slope) break;
    }
    if (!(length > until.shortest)) break;
    const Eigen::VectorXd s = candidate - x, y = new_gradient - gradient;
    const double sy = s.dot(y);
    if (sy > 1e-14 * s.norm() * y.norm()) {
      const Eigen::VectorXd Hy = H * y;
      H += ((1 + y.dot(Hy) / sy) / sy) * (s * s.transpose()) - (Hy * s.transpose() + s * Hy.transpose()) / sy;
    }
    const double before = value;
    x = candidate;
    value = new_value;
    gradient = new_gradient;
    if (before - value < until.progress * std::abs(before)) break;
  }
  return value;
}

}  // namespace holomorph::uv
