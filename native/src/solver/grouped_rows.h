// A sparse matrix as the cycle reads it: chunk by chunk, rows of equal length together.
#pragma once

#include <span>

#include "base/prefetch.h"
#include "solver/equal_rows.h"
#include "solver/wavefront.h"

namespace holomorph::solver {

/// The rows of each chunk in groups of equal length. A loop whose number of rounds changes from row to row costs more
/// by the processor's wrong guesses of its end than by its work.
class GroupedRows {
 public:
  /// Entries, 4 KB: asked for before the processor, which does not look beyond a page, would do so itself. A fifth of
  /// the time of a solution; it may lie beyond the end.
  static constexpr int kAhead = 512;

  GroupedRows() = default;
  /// Without entries, and with no order of the rows until each chunk is laid out.
  GroupedRows(int rows, int chunks) : row_(rows), groups_(chunks) {}

  /// All entries, for whoever lays out the rows to write.
  Array<Entry>& entries() { return entry_; }
  const Array<Entry>& entries() const { return entry_; }

  /// Makes the groups of a chunk whose rows are `begin` and those that follow, with offsets[k+1] - offsets[k] entries
  /// in the k-th, and whose entries are from `first` on. Within a group rows ascend.
  void lay_out(int chunk, int begin, std::span<const int> offsets, int first);

  /// The entries of a chunk, which follow one another.
  std::span<const Entry> of_chunk(int chunk) const;

  /// body(i, entries, length) for the rows i of a chunk; entries in the order of the matrix.
  template <class Body>
  void for_rows(int chunk, const Body& body) const {
    for (const Group group : groups_[chunk]) {
      const Entry* entries = entry_.data() + group.entries;
      const int* const row = row_.data();
      for (int r = group.begin; r < group.end; ++r, entries += group.length) {
        prefetch(entries + kAhead);
        body(row[r], entries, group.length);
      }
    }
  }

 private:
  struct Group {
    int length, begin, end, entries;  // rows begin .. end-1 of row_, the first one's entries
  };

  Array<Entry> entry_;
  Array<int> row_;
  std::vector<std::vector<Group>> groups_;  // of every chunk
};

/// The chunks of kWaveRows, of `chunks`, that a chunk of M has columns in, without order. Cost: linear.
std::vector<int> needs_of(const GroupedRows& M, int chunk, int chunks);

}  // namespace holomorph::solver
