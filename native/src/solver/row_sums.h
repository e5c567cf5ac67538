// A sparse row that is summed up from contributions in any order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/page_allocator.h"

namespace holomorph::solver {

/// The room in which one thread sums up rows. On cache lines of its own: threads that write to one line wait for each
/// other.
class alignas(128) RowSums {
  struct Entry {
    int row;  // the one that the sum belongs to
    double sum;
  };

 public:
  /// @param columns of the longest row, here and of all rows to come
  explicit RowSums(int columns) : entries_(columns), columns_(columns + std::size_t{1}) {
    std::fill(entries_.begin(), entries_.end(), Entry{-1, 0});
  }

  /// Sums by column, in double precision; the columns are listed in the order in which they came first. Adding is
  /// without a branch: whether a column is new cannot be predicted, and a wrong guess costs as much as five additions.
  class Row {
   public:
    void add(int column, double value) {
      Entry& entry = entries_[column];
      const bool known = entry.row == row_;
      columns_[size_] = column;
      size_ += !known;
      const auto sum = std::bit_cast<std::uint64_t>(entry.sum) & -static_cast<std::uint64_t>(known);
      entry.sum = std::bit_cast<double>(sum) + value;
      entry.row = row_;
    }

    int size() const { return size_; }
    int column(int k) const { return columns_[k]; }
    double sum(int k) const { return entries_[columns_[k]].sum; }

   private:
    friend RowSums;
    Row(Entry* entries, int* columns, int row) : entries_(entries), columns_(columns), row_(row) {}
    Entry* entries_;
    int* columns_;
    int row_, size_ = 0;
  };

  /// An empty row; it ends the one before. A value and not a part of this, so that it can be held in registers.
  Row next() { return {entries_.data(), columns_.data(), ++row_}; }

 private:
  Array<Entry> entries_;
  Array<int> columns_;  // one longer than a row can be, as add() writes before it knows
  int row_ = 0;
};

}  // namespace holomorph::solver
