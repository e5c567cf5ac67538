// Whether two surfaces are conformally equivalent, as far as the bounds of their periods tell (paper § 9).
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "moduli/period_lattice.h"

namespace holomorph::moduli {

/// R with R pairing_a R^T = sign pairing_b, |det R| = 1: row i is class i of b written in the classes of a.
struct Isometry {
  IntegerMatrix matrix;
  /// max |log of the ratio of R E_a R^T and E_b|, E the projected energies: a metric. For tori it is the hyperbolic
  /// distance of tau. The energies of corresponding classes differ at most by the factor exp(residual).
  double residual = 0;
  /// The bounds overlap if and only if this is <= 0. Else a map between the surfaces in the homotopy class of R
  /// stretches some direction exp(excess) times as much as another, since a map changes energies at most by its
  /// dilatation.
  double excess = 0;
};

struct Isometries {
  std::vector<Isometry> found;
  bool is_complete = true;  ///< false where the limit of steps ended the search
};

/// Limit of one search: some seconds.
inline constexpr std::int64_t kMostSteps = 20'000'000;

/// What is searched for, and how long.
struct SearchOptions {
  int sign = 1;                     ///< 1 keeps the orientation, -1 reverses it
  double slack = 0;                 ///< finds all R with excess <= slack, and 1e-9 more for rounding
  std::int64_t steps = kMostSteps;  ///< most steps of the search
};

/// Finds all R whose excess is at most `slack`. The search goes row by row, in a reduced basis of b from short to long.
/// Candidates are the lattice points near the one point that has the right energy products with the rows before. They
/// lie in the plane of points with the right wedge products. A candidate is dropped if the bounds exclude the block of
/// rows so far. Nothing that the bounds allow is ever dropped.
/// @throws SolverError, Cancelled, Error where integers leave 2^53
Isometries isometries(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options,
                      Execution& execution);

enum class Verdict { indistinguishable, mirror_image, not_equivalent, undecided };

struct Comparison {
  Verdict verdict = Verdict::undecided;
  std::optional<Isometry> isometry;  ///< the nearest that was found; none where there is none
  int sign = 1;                      ///< -1: it reverses the orientation
  /// The exact periods are certainly no further apart than this, in the metric of the residual; else infinite.
  double tolerance = 0;
  /// Not equivalent: every map between the surfaces, and between one and the mirror image of the other, stretches some
  /// direction at least exp(margin) times as much as another, somewhere. Indistinguishable, mirror image: by how much
  /// the residual is below what was asked for. Undecided: 0.
  double margin = 0;
  bool is_complete = true;  ///< false where a limit of steps ended a search that had to be complete
};

/// Indistinguishable, or mirror image: an integer matrix brings the projected periods of one surface as near to those
/// of the other as `needed` or `allowed`. Not equivalent: the bounds exclude that the exact periods are within
/// `allowed` by any integer matrix, orientation kept or reversed. Undecided: neither.
/// @param allowed residual that counts as none
/// @param needed residual up to which periods with errors count as the same
/// @param steps limit of each search
/// @throws SolverError, Cancelled, Error where integers leave 2^53
Comparison compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
                   Execution& execution);

}  // namespace holomorph::moduli
