// Periods and residues rounded together to a lattice: a closest-vector problem.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "linear/reduction.h"
#include "tiling/greens/pole_basis.h"
#include "uv/density_objective.h"

namespace holomorph::tiling {

// What is rounded, and what a rounding is measured by: a quadratic form around the target.

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

struct RoundingOptions {
  std::optional<double> phase;  ///< rotation of the target, in radians; none: any will do
  double max_turn = 0;          ///< largest change of a given phase, in radians
  bool steps = false;           ///< also tries short lattice steps away from the best roundings: other sizes
};

struct Rounding {
  linear::IntegerVector z;
  VectorXcd y;               ///< Z z
  double distortion = 1;     ///< added by the rounding: mean of (1 + |mu|) / (1 - |mu|), mu = B / A
  double density_ratio = 1;  ///< 95 % over 5 % quantile of |A|^2
  /// Lower is better: 5 (distortion - 1) + 0.15 log+(density ratio / 1.1 that of the target)
  /// + size weight |log(median of |A|^2 / the wanted one)|.
  double rank = 0;
};

/// How integers were found.
struct RoundingRecord {
  int integers = 0;        ///< for periods and residues
  int blocks = 1;          ///< blocks in which their lattice was reduced; 1: as a whole
  std::int64_t steps = 0;  ///< steps of the reductions
  /// Root mean square of the Gram-Schmidt lengths of the basis, over their geometric mean. It tells how much farther a
  /// rounding is from the target than with an orthogonal basis of the same volume.
  double excess = 1;
};

/// Searches for the best roundings. With many integers, the lattice is reduced by blocks and for fewer weights, and
/// fewer targets are rounded.
class RoundingSearch {
 public:
  /// Costs a reduction for each of five weights. @pre the problem outlives this; its number of tiles may change.
  /// @throws SolverError as linear/reduction.h does; Cancelled
  RoundingSearch(const RoundingProblem& problem, const RoundingOptions& options, Execution& execution);

  /// Returns the best roundings, the best first. There is none if each one distorts too much or is much less even than
  /// the target. The same errors.
  /// Cost: some thousand nearest planes, and 16 D more roundings with steps.
  std::vector<Rounding> best() const;
  const RoundingRecord& record() const { return record_; }

 private:
  struct Weighted {
    MatrixXcd rows;
    MatrixXd points;  // the target and a quarter turn of it, in the coordinates of the reduced basis
    linear::ReducedBasis reduced;
  };

  bool is_whole() const;
  std::vector<double> phases() const;
  int scales() const;
  Weighted weighted(const MatrixXcd& rows);
  linear::IntegerVector nearest(const Weighted& weighted, Complex by) const;

  const RoundingProblem& problem_;
  RoundingOptions options_;
  Execution& execution_;
  std::vector<Weighted> weighted_;
  RoundingRecord record_;
};

/// Computes the distortion, density ratio and rank of a rounding from its y.
void measure(const RoundingProblem& problem, Rounding& rounding);

}  // namespace holomorph::tiling
