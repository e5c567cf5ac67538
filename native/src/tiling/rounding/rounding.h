// Periods and residues rounded together to a lattice: a closest-vector problem.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "lattice/reduction.h"
#include "tiling/notation.h"
#include "uv/log_variance.h"

namespace holomorph::tiling {

/// The translations of the texture that leave it as it is: all integer combinations of two complex numbers.
struct TextureLattice {
  Complex a = 1, b = {0, 1};

  Complex point(double m, double n) const { return m * a + n * b; }
  /// Coordinates (m, n), integers at the lattice's points.
  Eigen::Vector2d coordinates(Complex z) const;
  Complex nearest(Complex z) const;
  /// The least turn that takes it to itself, in radians: pi / 2, pi / 3 or, of most lattices, pi.
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
  MatrixXcd repairable;         ///< l x l covariance of the t that moving the poles takes up; empty: none
  double tiles = 1;             ///< over the surface at its median density, which are wanted
  double size_weight = 0.05;    ///< how much the median density counts in the rank of a rounding
  double median_density = 1;    ///< the same number over the area
};

/// Upper R with |R t|^2 = mean |defects t / theta_0|^2, theta_0 the target, floored.
MatrixXcd defect_metric(const RoundingProblem& problem);

struct RoundingOptions {
  std::optional<double> phase;  ///< which the target is given, in radians; none: any
  double max_turn = 0;          ///< largest change of a given phase, in radians
  bool steps = false;           ///< also those a short step away from the best are looked at: other sizes
};

struct Rounding {
  lattice::IntegerVector z;
  VectorXcd y;               ///< Z z
  double distortion = 1;     ///< added by the rounding: mean of (1 + |mu|) / (1 - |mu|), mu = B / A
  double density_ratio = 1;  ///< 95 % over 5 % quantile of |A|^2
  /// The less the better: 5 (distortion - 1) + 0.15 log+(density ratio / 1.1 that of the target)
  /// + size weight |log(median of |A|^2 / the wanted one)|.
  double rank = 0;
};

/// The best roundings, the best first: none where every one has a residue 0 or is flipped somewhere.
/// @throws SolverError as lattice.h does
/// Cost: a reduction for each of five weights, some thousand nearest planes, and 16 D more roundings with steps.
std::vector<Rounding> roundings(const RoundingProblem& problem, const RoundingOptions& options, Execution& execution);

/// What follows from y.
void measure(const RoundingProblem& problem, Rounding& rounding);

}  // namespace holomorph::tiling
