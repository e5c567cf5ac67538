// Building a sparse matrix in parallel where the length of a row is known only when it is done.
#pragma once

#include <mutex>
#include <utility>

#include "base/execution.h"
#include "solver/sparse_rows.h"

namespace holomorph::solver {

/// The rows of one chunk on their way into a matrix; on cache lines of its own.
struct alignas(128) RowPart {
  std::vector<int> offsets;  // of each row, and the end of the last one
  Array<Entry> entry;        // longer than what is used of it
  std::size_t size = 0;

  void clear() {
    offsets.assign(1, 0);
    size = 0;
  }
  /// Makes room for so many entries of the next row.
  void make_room(std::size_t entries) {
    if (size + entries > entry.size()) entry.resize(2 * (size + entries));
  }
  /// An entry that is not kept is overwritten by the next one: without a branch that cannot be predicted.
  void append(int column, float weight, bool kept) {
    entry[size] = {column, weight};
    size += kept;
  }
  void end_row() { offsets.push_back(static_cast<int>(size)); }
};

/// A matrix into which threads put its chunks in any order, each copied while it is still in a cache. Where in memory
/// it lies depends on that order, and nothing else.
class CollectedRows {
 public:
  CollectedRows(int rows, std::size_t expected_entries);

  /// @throws std::bad_alloc
  void add(int chunk, const RowPart& part);
  /// When all chunks are there. @throws std::bad_alloc
  SparseRows result();

 private:
  void put(int chunk, const RowPart& part, std::size_t first);

  SparseRows matrix_;
  std::mutex mutex_;
  std::size_t used_ = 0;
  std::vector<std::pair<int, RowPart>> beyond_;  // chunks for which there was no room
};

/// Builds a matrix with `rows` rows in parallel. make_row(thread, i, part) appends the entries of row i to `part`;
/// which thread it is must not influence the row. @throws std::bad_alloc, Cancelled
template <class MakeRow>
SparseRows build_rows(int rows, std::size_t expected_entries, Workers& workers, Execution& execution,
                      const MakeRow& make_row) {
  CollectedRows result(rows, expected_entries);
  std::vector<RowPart> parts(workers.count());
  for_set_up_chunks(workers, rows, execution, [&](int thread, int chunk, int begin, int end) {
    RowPart& part = parts[thread];
    part.clear();
    for (int i = begin; i < end; ++i) {
      make_row(thread, i, part);
      part.end_row();
    }
    result.add(chunk, part);
  });
  return result.result();
}

}  // namespace holomorph::solver
