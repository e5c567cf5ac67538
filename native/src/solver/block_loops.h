// K values at every vertex, and the loops over the rows of a level that apply its matrices to them.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "solver/ahead.h"
#include "solver/grouped_rows.h"

namespace holomorph::solver {

/// The K values at one vertex, side by side: one or two registers.
template <int K>
using Block = Eigen::Array<float, K, 1>;
template <int K>
using Blocks = Array<Block<K>>;
/// Sums over vertices, one per right-hand side.
template <int K>
using Sums = Eigen::Array<double, K, 1>;

// Bodies of the loops below capture pointers by value: to the compiler a block that is written may be one of the
// pointers of an array, which would be read again for every row.

/// body(i, (A x)_i) for the rows of a chunk, with (A x)_i = sum_j w_ij (x_i - x_j); meanwhile asks for what is ahead,
/// as many lines as a row of x is long.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_differences(const GroupedRows& A, int chunk, const Block<K>* x, const Body& body,
                                         Ahead ahead = {}) {
  A.for_rows(chunk, [x, body, &ahead](int i, const Entry* entries, int length) {
    const Block<K> here = x[i];
    Block<K> sum = Block<K>::Zero();
    for (int e = 0; e < length; ++e) sum += entries[e].weight * (here - x[entries[e].column]);
    for (int line = 0; line < (K + 3) / 4; ++line) ahead.ask();
    body(i, sum);
  });
}

/// body(i, (R x)_i) for the rows of a chunk.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const GroupedRows& R, int chunk, const Block<K>* x, const Body& body) {
  R.for_rows(chunk, [x, body](int i, const Entry* entries, int length) {
    Block<K> sum = Block<K>::Zero();
    for (int e = 0; e < length; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  });
}

/// body(i, (P x)_i) for the rows begin .. end-1.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const EqualRows& P, int begin, int end, const Block<K>* x, const Body& body) {
  const int each = P.each;
  const Entry* entries = P[begin];
  for (int i = begin; i < end; ++i, entries += each) {
    prefetch(entries + GroupedRows::kAhead);
    Block<K> sum = entries[0].weight * x[entries[0].column];
    for (int e = 1; e < each; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  }
}

/// omega r, the smoother's step; 0 at a held vertex for the right-hand sides that hold it.
/// @param natural 1 for the right-hand sides that do not, 0 for the others
template <int K>
EIGEN_STRONG_INLINE Block<K> jacobi_step(float omega, const Block<K>& r, const Block<K>& natural) {
  if (omega >= 0) return omega * r;
  return (-omega * natural) * r;
}

/// The r of a jacobi_step(), where its right-hand side does not hold the vertex.
template <int K>
EIGEN_STRONG_INLINE Block<K> residual_of_step(float omega, const Block<K>& step) {
  const float size = std::abs(omega);
  return (size > 0 ? 1 / size : 0.0F) * step;
}

}  // namespace holomorph::solver
