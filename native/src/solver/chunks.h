// Loops over rows with the same bits at any number of threads: fixed chunks, each row written by one thread, sums per
// chunk and then in the order of the chunks. No atomics, no reductions, nothing that depends on the number of threads.
#pragma once

#include <algorithm>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace holomorph::solver {

/// Rows of a chunk: enough work to be worth handing out, few enough to share out the rows of a coarse level.
inline constexpr int kChunk = 4096;

inline int chunk_count(int rows) { return (rows + kChunk - 1) / kChunk; }

inline int most_threads() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

inline int this_thread() {
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

/// body(chunk, first row, end of rows) for the chunks `from` .. `to` - 1, in parallel. @pre body does not throw
template <class Body>
void for_chunks(int from, int to, int rows, const Body& body) {
#ifdef _OPENMP
#pragma omp parallel for schedule(static) if (to - from > 1)
#endif
  for (int c = from; c < to; ++c) body(c, c * kChunk, std::min((c + 1) * kChunk, rows));
}

/// body(row) for every row, in parallel. @pre body does not throw
template <class Body>
void for_rows(int rows, const Body& body) {
  for_chunks(0, chunk_count(rows), rows, [&](int, int first, int end) {
    for (int i = first; i < end; ++i) body(i);
  });
}

/// Sum over all rows of what body(row, sum) adds to `sum`, begun at `zero` in every chunk. @pre body does not throw
template <class Sum, class Body>
Sum sum_over_rows(int rows, const Sum& zero, const Body& body) {
  std::vector<Sum> parts(chunk_count(rows), zero);
  for_chunks(0, chunk_count(rows), rows, [&](int c, int first, int end) {
    Sum sum = zero;
    for (int i = first; i < end; ++i) body(i, sum);
    parts[c] = sum;
  });
  Sum total = zero;
  for (const Sum& part : parts) total += part;
  return total;
}

}  // namespace holomorph::solver
