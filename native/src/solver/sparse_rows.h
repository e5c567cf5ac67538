// A sparse matrix in single precision, row by row.
#pragma once

#include "base/chunks.h"
#include "base/page_allocator.h"
#include "base/progress.h"

namespace holomorph::solver {

/// Row i has the entries start[i] .. start[i+1]-1: `column`, in a fixed order of no meaning, and `weight`.
struct SparseRows {
  Array<int> start{0};
  Array<int> column;
  Array<float> weight;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Rows of a chunk of the set-up: its loops do more for a row than those of a cycle, and coarse levels have few rows.
inline constexpr int kSetUpChunk = 1024;

inline int set_up_chunks(int rows) { return (rows + kSetUpChunk - 1) / kSetUpChunk; }

/// body(thread, chunk, begin, end) for the rows begin .. end-1 of every chunk, in parallel; asks `progress` between
/// batches of some 10 ms, so that cancelling is answered soon. @pre body does not throw
template <class Body>
void for_set_up_chunks(Workers& workers, int rows, Progress& progress, const Body& body) {
  constexpr int kBatch = 256;
  for (int first = 0; first < set_up_chunks(rows); first += kBatch) {
    progress.report(0);
    workers.run(std::min(kBatch, set_up_chunks(rows) - first), [&](int thread, int c) {
      const int begin = (first + c) * kSetUpChunk;
      body(thread, first + c, begin, std::min(begin + kSetUpChunk, rows));
    });
  }
}

/// The transpose, entries of a row in ascending order. Cost: two passes over the entries, in parallel where the columns
/// of neighbouring rows are near each other.
SparseRows transposed(const SparseRows& M, int columns, Workers& workers, Progress& progress);

}  // namespace holomorph::solver
