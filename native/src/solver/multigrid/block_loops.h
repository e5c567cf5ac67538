// K values at every vertex, and the loops over rows that apply a level's matrices to them.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/page_allocator.h"
#include "solver/multigrid/sparse_rows.h"

namespace holomorph::solver {

/// The K values at one vertex, side by side: one or two registers.
template <int K>
using Block = Eigen::Array<float, K, 1>;
template <int K>
using Blocks = Array<Block<K>>;
/// Sums over vertices, one per right-hand side.
template <int K>
using Sums = Eigen::Array<double, K, 1>;

/// Prefetch distance, in entries, 4 KB: the processor does not look beyond a page by itself.
inline constexpr int kAhead = 512;

/// A range of rows, such as a chunk.
struct Rows {
  int begin, end;
};

inline Rows rows_of_chunk(int chunk, int rows, int each = kChunkRows) {
  return {std::min(chunk * each, rows), std::min((chunk + 1) * each, rows)};
}

/// Calls loop(chunk, rows) for all chunks with this number of rows, in parallel. @pre loop does not throw
template <class Loop>
void for_chunks(int rows, Workers& workers, const Loop& loop) {
  workers.run(row_chunks(rows), [&](int, int chunk) { loop(chunk, rows_of_chunk(chunk, rows)); });
}

// Bodies of the loops below capture pointers by value. Otherwise the compiler reads them again for every row: for all
// it knows, the block that a body writes is one of them.

/// body(i, (A x)_i) for the rows of a chunk, with (A x)_i = sum_j w_ij (x_i - x_j).
template <int K, class Body>
EIGEN_STRONG_INLINE void for_differences(const SparseRows& A, Rows rows, const Block<K>* x, const Body& body) {
  const int *const starts = A.starts.data(), *const ends = A.ends.data(), *const order = A.order.data();
  const Entry* const entries = A.entries.data();
  for (int k = rows.begin; k < rows.end; ++k) {
    const int i = order[k];
    prefetch(entries + starts[i] + kAhead);
    const Block<K> here = x[i];
    Block<K> sum = Block<K>::Zero();
    for (int e = starts[i], end = ends[i]; e < end; ++e) sum += entries[e].weight * (here - x[entries[e].column]);
    body(i, sum);
  }
}

/// body(i, (R x)_i) for a range of rows.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const SparseRows& R, Rows rows, const Block<K>* x, const Body& body) {
  const int *const starts = R.starts.data(), *const ends = R.ends.data();
  const Entry* const entries = R.entries.data();
  for (int i = rows.begin; i < rows.end; ++i) {
    Block<K> sum = Block<K>::Zero();
    for (int e = starts[i], end = ends[i]; e < end; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  }
}

/// body(i, (P x)_i) for a range of rows.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const EqualRows& P, Rows rows, const Block<K>* x, const Body& body) {
  const int each = P.each;
  const Entry* entries = P[rows.begin];
  for (int i = rows.begin; i < rows.end; ++i, entries += each) {
    Block<K> sum = entries[0].weight * x[entries[0].column];
    for (int e = 1; e < each; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  }
}

/// omega r, the smoother's step; 0 at a fixed vertex for the right-hand sides with the Dirichlet condition.
/// @param natural 1 for the right-hand sides with the natural condition, 0 for the others
template <int K>
EIGEN_STRONG_INLINE Block<K> jacobi_step(float omega, const Block<K>& r, const Block<K>& natural) {
  if (omega >= 0) return omega * r;
  return (-omega * natural) * r;
}

/// Returns the residual r that gave a jacobi_step(), where the vertex is not fixed.
template <int K>
EIGEN_STRONG_INLINE Block<K> residual_of_step(float omega, const Block<K>& step) {
  const float size = std::abs(omega);
  return (size > 0 ? 1 / size : 0.0F) * step;
}

}  // namespace holomorph::solver
