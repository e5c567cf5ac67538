// Whether two surfaces are conformally equivalent, as far as the bounds of their periods tell (paper § 9).
#pragma once

#include <optional>

#include "moduli/isometries.h"

namespace holomorph::moduli {

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
