// Sparse matrices in single precision, and loops over their rows.
#pragma once

#include <span>
#include <vector>

#include "base/chunks.h"
#include "base/execution.h"
#include "base/page_allocator.h"

namespace holomorph::solver {

struct Entry {
  int column;
  float weight;
};

/// Compressed rows.
struct SparseRows {
  Array<int> starts, ends;  ///< #rows, where the entries of each begin and end
  Array<Entry> entries;     ///< in each row in any order, but the same at any number of threads
  Array<int> order;         ///< the rows as they lie in memory, of build_rows()

  int size() const { return static_cast<int>(starts.size()); }
  std::span<const Entry> operator[](int i) const { return {entries.data() + starts[i], entries.data() + ends[i]}; }
};

/// Rows of `each` entries, the largest weight first. Missing ones have weight 0 and the first one's column, which is in
/// the cache already. A loop of constant length is cheaper.
struct EqualRows {
  int each = 1;
  Array<Entry> entries;

  int size() const { return static_cast<int>(entries.size()) / each; }
  const Entry* operator[](int i) const { return entries.data() + static_cast<std::ptrdiff_t>(each) * i; }
};

/// Rows of a chunk in the loops of the solver: few, as coarse levels are small.
inline constexpr int kChunkRows = 512;

inline int row_chunks(int rows) { return (rows + kChunkRows - 1) / kChunkRows; }

/// Calls body(thread, chunk, begin, end) for the rows begin .. end-1 of every chunk, in parallel. Asks `execution`
/// whether to stop between batches of some 10 ms. @throws what the first body threw, Cancelled
template <class Body>
void for_row_chunks(int rows, Execution& execution, const Body& body) {
  constexpr int kBatch = 256;
  for (int first = 0; first < row_chunks(rows); first += kBatch) {
    execution.report(0);
    run_throwing(execution.workers(), std::min(kBatch, row_chunks(rows) - first), [&](int thread, int c) {
      const int begin = (first + c) * kChunkRows;
      body(thread, first + c, begin, std::min(begin + kChunkRows, rows));
    });
  }
}

/// Builds the matrix whose chunks of rows have these entries.
/// @param ends #rows, of each row in its chunk's part
SparseRows joined(Array<int>&& ends, const std::vector<std::vector<Entry>>& parts, Execution& execution);

/// A matrix with `rows` rows, built in parallel: make_row(thread, i, part) appends the entries of row i to `part`. It
/// lies in memory chunk by chunk, in each the shortest rows first. Where the lengths of rows alternate, mispredicted
/// ends of the loop over a row cost more than its work.
/// @param make_row its result must not depend on the thread @throws std::bad_alloc, Cancelled
template <class MakeRow>
SparseRows build_rows(int rows, Execution& execution, const MakeRow& make_row) {
  Array<int> ends(rows);
  std::vector<std::vector<Entry>> parts(row_chunks(rows));
  for_row_chunks(rows, execution, [&](int thread, int chunk, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      make_row(thread, i, parts[chunk]);
      ends[i] = static_cast<int>(parts[chunk].size());
    }
  });
  return joined(std::move(ends), parts, execution);
}

/// Returns the transpose, without zeros; entries of a row ascending. Cost: two passes over the entries, one thread.
SparseRows transposed(const EqualRows& M, int columns);

}  // namespace holomorph::solver
