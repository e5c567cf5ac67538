// What is rounded, and what a rounding is measured by: a quadratic form around the target.
#pragma once

#include "base/execution.h"
#include "tiling/notation.h"
#include "uv/density_objective.h"

namespace holomorph::tiling {

/// The translations of the texture that leave it as it is: all integer combinations of two complex numbers.
struct TextureLattice {
  Complex a = 1, b = {0, 1};

  Complex point(double m, double n) const { return m * a + n * b; }
  /// Coordinates (m, n), integers at the lattice's points.
  Eigen::Vector2d coordinates(Complex z) const;
  Complex nearest(Complex z) const;
  bool has(Complex z) const;  ///< up to rounding, z not 0
  /// The least rotation that takes the lattice to itself, in radians: pi / 2, pi / 3 or, for most lattices, pi.
  double symmetry() const;
};

/// Forms in coordinates y = (c_j, r_i, t_l): A = forms y on the samples, and B = defects t, what keeps the form from
/// being conformal. With D integers z for the periods and residues, y = Z z.
struct RoundingProblem {
  uv::Coefficients kind;
  MatrixXcd forms;              ///< #samples x (n + k + l)
  MatrixXcd defects;            ///< #samples x l
  MatrixXcd periods, residues;  ///< #loops x D, k x D: what the integers stand for
  MatrixXcd Z;                  ///< (n + k + l) x D
  VectorXcd target;             ///< n + k + l: the form as it would be without rounding, t = 0
  ArrayXd target_density;       ///< |forms target|^2
  double target_ratio = 1;      ///< 95 % over 5 % quantile of it
  TextureLattice lattice;       ///< which periods and residues are rounded to
  MatrixXcd defect_metric;      ///< l x l, upper R: |R t|^2 = mean |defects t / theta_0|^2, theta_0 the target, floored
  MatrixXcd repairable;         ///< l x l covariance of the t that moving the poles takes up; empty: none
  double tiles = 1;             ///< number wanted on the surface, at its median density
  double size_weight = 0.05;    ///< how much the median density counts in the rank of a rounding
  double median_density = 1;    ///< wanted median of |A|^2: `tiles` over the area
};

/// Returns 1 / |theta_0|^2, floored, as weights of means over samples with this density.
VectorXcd mean_weights(const ArrayXd& density);

/// Computes the upper R with |R t|^2 = mean |defects t / theta_0|^2, theta_0 the target of that density, floored.
MatrixXcd defect_metric(const MatrixXcd& defects, const ArrayXd& target_density, Execution& execution);

/// Measures y near the target by the length of rows * y: the change of the form, and its defects at a price.
class RoundingMetric {
 public:
  /// @pre the problem outlives this
  RoundingMetric(const RoundingProblem& problem, Execution& execution);

  /// Returns #rows x (n + k + l). @param defect |mu| that costs 1
  MatrixXcd rows(double defect) const;

 private:
  const RoundingProblem& problem_;
  MatrixXcd of_change_;
};

/// A * B, in parallel where that is much work.
MatrixXcd product(const MatrixXcd& A, const MatrixXcd& B, Execution& execution);

}  // namespace holomorph::tiling
