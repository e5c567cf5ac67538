// The right-hand sides of one block, as they are solved for.
#pragma once

#include <array>

#include "solver/block_loops.h"

namespace holomorph::solver {

/// Nothing is asked of x where it is held, and without held vertices the mean is left out, the part of the rounding
/// that no x can answer for. A value, to be captured as one: loops over it write doubles, behind which the compiler
/// would look for each pointer and sum anew.
template <int K>
struct RightHandSides {
  std::array<const double*, K> columns;
  Sums<K> natural;     ///< 1 for those that hold no vertex, 0 for the others
  const float* omega;  ///< of CycleLevel
  Sums<K> mean = Sums<K>::Zero();

  /// Entry i of each.
  EIGEN_STRONG_INLINE Sums<K> operator()(int i) const {
    Sums<K> all;
    for (int d = 0; d < K; ++d) all[d] = columns[d][i];
    return asked(i, all - mean);
  }

  /// What a residual r at vertex i asks of x.
  EIGEN_STRONG_INLINE Sums<K> asked(int i, const Sums<K>& r) const {
    if (omega[i] >= 0) return r;
    return r * natural;
  }
};

}  // namespace holomorph::solver
