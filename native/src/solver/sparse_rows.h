// A sparse matrix in single precision, row by row.
#pragma once

#include <cstdint>
#include <exception>

#include "base/chunks.h"
#include "base/page_allocator.h"
#include "base/progress.h"

namespace holomorph::solver {

/// Row i has the entries start[i] .. start[i+1]-1: `column` (ascending) and `weight`.
struct SparseRows {
  Array<int> start{0};
  Array<int> column;
  Array<float> weight;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Builds a matrix with `rows` rows in parallel. make_row(scratch, i, part) appends the entries of row i to part.column
/// and part.weight; every thread has a `scratch` of its own, made by make_scratch(), which must not influence the row.
template <class MakeScratch, class MakeRow>
SparseRows build_rows(int rows, std::size_t expected_entries, Workers& workers, Progress& progress,
                      const MakeScratch& make_scratch, const MakeRow& make_row) {
  // Chunks of one batch: some milliseconds, so that cancelling is answered soon.
  constexpr int kBatch = 16;
  SparseRows result;
  result.start.reserve(rows + std::size_t{1});
  result.column.reserve(expected_entries);
  result.weight.reserve(expected_entries);
  // Each on cache lines of its own: threads that write to one line wait for each other.
  struct alignas(128) Scratch {
    decltype(make_scratch()) own;
  };
  std::vector<Scratch> scratch;
  for (int t = 0; t < workers.count(); ++t) scratch.push_back({make_scratch()});
  struct alignas(128) Part {
    std::vector<int> ends, column;
    std::vector<float> weight;
    std::exception_ptr failure;  // out of memory
  };
  std::vector<Part> parts(kBatch);
  for (int first = 0; first < chunk_count(rows); first += kBatch) {
    const int end = std::min(first + kBatch, chunk_count(rows));
    progress.report(0);
    workers.run(end - first, [&](int thread, int c) {
      Part& part = parts[c];
      const int begin_row = (first + c) * kChunk, end_row = std::min(begin_row + kChunk, rows);
      part.ends.clear();
      part.column.clear();
      part.weight.clear();
      try {
        for (int i = begin_row; i < end_row; ++i) {
          make_row(scratch[thread].own, i, part);
          part.ends.push_back(static_cast<int>(part.column.size()));
        }
      } catch (...) {
        part.failure = std::current_exception();
      }
    });
    for (int c = first; c < end; ++c) {
      const Part& part = parts[c - first];
      if (part.failure) std::rethrow_exception(part.failure);
      const int before = result.start.back();
      for (const int row_end : part.ends) result.start.push_back(before + row_end);
      result.column.insert(result.column.end(), part.column.begin(), part.column.end());
      result.weight.insert(result.weight.end(), part.weight.begin(), part.weight.end());
    }
  }
  return result;
}

}  // namespace holomorph::solver
