// Interpolation from the C-points to all vertices of a level.
#pragma once

#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {

/// P, n x #C: extended+i interpolation (De Sterck, Falgout, Nolting & Yang 2008, doi:10.1002/nla.559). The value at an
/// F-point i is a mean over its neighbours. A neighbour that is an F-point is replaced by a mean over its own
/// C-neighbours and i. The sum is solved for the value at i. Only positive weights are used, and only the `most`
/// largest entries of the result are kept.
///
/// Every row sums to 1 exactly: all weights but the largest are multiples of 2^-20. Then constants are interpolated
/// exactly, and the rounding of a large weight of a sliver does not become a coupling on the coarse level. The row of a
/// fixed vertex has entries at fixed ones alone. So a coarse function that is 0 at the fixed vertices is 0 there on the
/// fine level, too. P^T A P without their rows and columns is the coarse operator of A without them.
/// @param most 2 or 3
/// @throws std::bad_alloc, Cancelled
/// Cost: linear, in parallel.
EqualRows interpolation(const Operator& fine, const Coarsening& coarse, int most, Execution& execution);

}  // namespace holomorph::solver
