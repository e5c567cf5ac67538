// How uneven the texture density of a form is: the variance of its logarithm on samples of the surface.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "forms/closed_forms.h"
#include "mesh/half_edges.h"

namespace holomorph::uv {

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

/// Variance over the samples of log(q / mean q + floor), q = |A|^2, plus 3 times the mean of
/// r = |B|^2 / (|A|^2 + |B|^2 + floor mean q); and the gradient by (Re c, Im c). The second term is nearly 0 for a good
/// map. Without it |A| may be even where B, the discretisation error, is larger and flips the map.
class DensityObjective {
 public:
  DensityObjective(const SampledParts& parts, Coefficients kind);
  void set_floor(double floor) { floor_ = floor; }
  double operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

 private:
  Eigen::VectorXd parts(const Eigen::MatrixXd& M, const Eigen::VectorXd& x) const;
  Eigen::VectorXd transposed(const Eigen::MatrixXd& M, const Eigen::VectorXd& w) const;

  // Real parts of A and B above imaginary ones, of each unknown; where these are many, of the coefficients alone.
  Eigen::MatrixXd M_, N_;
  bool are_many_;
  Eigen::Index columns_;  // of the unknowns, a row for each coefficient: real and imaginary parts
  double floor_ = 0;
};

/// The last floor under the density, relative to its mean.
inline constexpr double kDensityFloor = 1e-4;

/// Minimises with one floor after the other, from `x`, whose scale is free. @return the last variance
/// @param tick called for each value of the objective; it may throw
double descend(const SampledParts& parts, Coefficients kind, Eigen::VectorXd& x, const std::vector<double>& floors,
               int most_steps, const std::function<void()>& tick);

}  // namespace holomorph::uv
