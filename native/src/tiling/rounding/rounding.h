// Periods and residues rounded together to a lattice: a closest-vector problem.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "linear/reduction.h"
#include "tiling/rounding/rounding_metric.h"

namespace holomorph::tiling {

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
