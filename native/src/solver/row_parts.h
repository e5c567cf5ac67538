// Building a sparse matrix in parallel where the length of a row is known only when it is done.
#pragma once

#include <exception>
#include <memory>
#include <mutex>

#include "solver/sparse_rows.h"

namespace holomorph::solver {

/// The rows of one chunk on their way into a matrix.
struct RowPart {
  std::vector<int> ends;  // of each row
  Array<int> column;      // longer than what is used of it, like `weight`
  Array<float> weight;
  std::size_t size = 0;

  /// Makes room for so many entries of the next row.
  void make_room(std::size_t entries) {
    if (size + entries <= column.size()) return;
    column.resize(2 * (size + entries));
    weight.resize(column.size());
  }
  /// An entry that is not kept is overwritten by the next one: without a branch that cannot be predicted.
  void append(int c, float w, bool kept) {
    column[size] = c;
    weight[size] = w;
    size += kept;
  }
};

/// Parts that threads finish in any order, appended to a matrix in the order of the chunks: by whichever thread comes
/// when the next one is ready. Nobody waits, and a part is copied while it is still in a cache.
class PartsInOrder {
 public:
  PartsInOrder(SparseRows& result, int chunks) : result_(result), done_(chunks) {}

  /// For the thread that begins a chunk. @throws std::bad_alloc
  std::unique_ptr<RowPart> take();
  void finish(int chunk, std::unique_ptr<RowPart> part);

  /// Keeps the first failure, which is out of memory, for rethrow().
  void fail(std::exception_ptr failure);
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void append(const RowPart& part);

  SparseRows& result_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<RowPart>> done_, free_;
  std::size_t next_ = 0;
  bool appending_ = false;
  std::exception_ptr failure_;
};

/// Builds a matrix with `rows` rows in parallel. make_row(thread, i, part) appends the entries of row i to `part`;
/// which thread it is must not influence the row. @throws std::bad_alloc, Cancelled
template <class MakeRow>
SparseRows build_rows(int rows, std::size_t expected_entries, Workers& workers, Progress& progress,
                      const MakeRow& make_row) {
  SparseRows result;
  result.start.reserve(rows + std::size_t{1});
  result.column.reserve(expected_entries);
  result.weight.reserve(expected_entries);
  PartsInOrder parts(result, set_up_chunks(rows));
  for_set_up_chunks(workers, rows, progress, [&](int thread, int chunk, int begin, int end) {
    try {
      auto part = parts.take();
      for (int i = begin; i < end; ++i) {
        make_row(thread, i, *part);
        part->ends.push_back(static_cast<int>(part->size));
      }
      parts.finish(chunk, std::move(part));
    } catch (...) {
      parts.fail(std::current_exception());
    }
  });
  parts.rethrow();
  return result;
}

}  // namespace holomorph::solver
