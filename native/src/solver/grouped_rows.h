// A sparse matrix as the cycle reads it: chunk by chunk, rows of equal length together.
#pragma once

#include "base/prefetch.h"
#include "solver/sparse_rows.h"
#include "solver/wavefront.h"

namespace holomorph::solver {

/// The rows of each chunk in groups of equal length. A loop whose number of rounds changes from row to row costs more
/// by the processor's wrong guesses of its end than by its work.
class GroupedRows {
 public:
  struct Entry {
    int column;
    float weight;
  };

  GroupedRows() = default;
  GroupedRows(const SparseRows& M, const Chunks& rows, int chunks, Workers& workers);

  std::size_t entries() const { return entry_.size(); }

  /// body(i, entries, length) for the rows i of a chunk; entries in the order of the matrix.
  template <class Body>
  void for_rows(int chunk, const Body& body) const {
    for (int g = first_[chunk]; g < first_[chunk + 1]; ++g) {
      const Group group = groups_[g];
      const Entry* entries = entry_.data() + group.entries;
      const int* const row = row_.data();
      for (int r = group.begin; r < group.end; ++r, entries += group.length) {
        prefetch(entries + kAhead);
        body(row[r], entries, group.length);
      }
    }
  }

 private:
  // Entries, 4 KB: asked for before the processor, which does not look beyond a page, would do so itself. A fifth of
  // the time of a solution; it may lie beyond the end.
  static constexpr int kAhead = 512;
  struct Group {
    int length, begin, end, entries;  // rows begin .. end-1 of row_, the first one's entries
  };
  std::vector<Group> group(const SparseRows& M, int begin, int end);

  Array<Entry> entry_;
  Array<int> row_;
  std::vector<Group> groups_;
  std::vector<int> first_;  // group of a chunk
};

}  // namespace holomorph::solver
