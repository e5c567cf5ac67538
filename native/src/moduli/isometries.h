// Integer matrices that bring the periods of one surface to those of another (Plesken & Souvignier 1997,
// doi:10.1006/jsco.1996.0130), within the bounds of both.
#pragma once

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

}  // namespace holomorph::moduli
