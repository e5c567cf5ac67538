// The right-hand sides of one block, as they are solved for.
#pragma once

#include <array>

#include "solver/multigrid/block_loops.h"

namespace holomorph::solver {

/// With the Dirichlet condition nothing is asked of x at a fixed vertex. With the natural one the mean is subtracted:
/// it is rounding, and no x solves for it. To be captured by value: loops over it write doubles, and the compiler would
/// otherwise reload the pointers and sums after each write.
template <int K>
struct RightHandSides {
  std::array<const double*, K> columns;
  Sums<K> natural;     ///< 1 for those with the natural condition, 0 for the others
  const float* omega;  ///< `omega` of Operator
  Sums<K> mean = Sums<K>::Zero();

  /// Entry i of each.
  EIGEN_STRONG_INLINE Sums<K> operator()(int i) const {
    Sums<K> all;
    for (int d = 0; d < K; ++d) all[d] = columns[d][i];
    return masked(i, all - mean);
  }

  /// A residual r at vertex i, 0 where nothing is asked of x.
  EIGEN_STRONG_INLINE Sums<K> masked(int i, const Sums<K>& r) const {
    if (omega[i] >= 0) return r;
    return r * natural;
  }
};

}  // namespace holomorph::solver
