// How uneven the texture density of a form is: the variance of its logarithm on samples of the surface.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "forms/closed_forms.h"
#include "mesh/half_edges.h"

namespace holomorph::uv {

/// When a minimiser stops.
struct Minimising {
  int most_steps = 200;
  double progress = 1e-9;   ///< stops after a step that lowers the value by less than this part of it
  double shortest = 1e-12;  ///< step, relative to the full one
};

/// @param objective double(const VectorXd& x, VectorXd& gradient)
/// Minimises a function of a few variables by BFGS with backtracking (Nocedal & Wright 2006, algorithm 6.1,
/// doi:10.1007/978-0-387-40065-5). @param x start in, minimum out. @return the least value
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

inline constexpr int kSamples = 3000;  ///< triangles on which the density is sampled, evenly spaced by area

/// Samples of forms: their values on two sides of a few thousand triangles.
struct FormSamples {
  std::vector<int> triangles;      ///< evenly spaced by area; all of them on a small surface, some more than once
  forms::RowMajorMatrix on_sides;  ///< (2 #triangles) x #forms, along sides 0 and 1 of each
};
/// Returns kSamples triangles, evenly spaced by area. @param most_per_triangle on average: a small surface has fewer
/// samples
std::vector<int> sample_triangles(const mesh::Surface& surface, int most_per_triangle = kSamples);
forms::RowMajorMatrix values_on_sides(const mesh::Surface& surface, const mesh::Sides& sides,
                                      const forms::ClosedForms& forms, const std::vector<int>& triangles);

/// A form is A dz + B conj(dz) on each triangle, z along its side 0; A = M c and B = N c on the samples.
struct SampledParts {
  Eigen::MatrixXcd M;  ///< #samples x #coefficients
  Eigen::MatrixXcd N;  ///< the same, or without rows where B is known to be 0
};

/// Computes the parts of combinations of harmonic forms. @param basis #forms x #coefficients
SampledParts sampled_parts(const mesh::Surface& surface, const FormSamples& samples, const Eigen::MatrixXcd& basis);

/// Computes A of the holomorphic du + i dv from v alone, one column for each column of v. @param v #V x m
Eigen::MatrixXcd parts_of_imaginary(const mesh::Surface& surface, const std::vector<int>& triangles,
                                    const forms::RowMajorMatrix& v);

enum class Coefficients { complex, real };

/// Converts c to the unknowns of the minimiser, and back: real parts, then imaginary ones where they are free.
Eigen::VectorXcd as_complex(const Eigen::VectorXd& x, Coefficients kind);
Eigen::VectorXd as_unknowns(const Eigen::VectorXcd& c, Coefficients kind);

/// The last floor under the density, relative to its mean.
inline constexpr double kDensityFloor = 1e-4;

/// Minimises with one floor after the other, from `x`, whose scale is free. @return the last variance
/// @param tick called for each value of the objective; it may throw
double descend(const SampledParts& parts, Coefficients kind, Eigen::VectorXd& x, const std::vector<double>& floors,
               int most_steps, const std::function<void()>& tick);

}  // namespace holomorph::uv
