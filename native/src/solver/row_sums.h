// A sparse row that is summed up from contributions in any order.
#pragma once

#include <algorithm>

#include "base/page_allocator.h"

namespace holomorph::solver {

/// The room in which one thread sums up rows. On cache lines of its own: threads that write to one line wait for each
/// other.
template <class Scalar>
class alignas(128) RowSums {
 public:
  /// @param columns of the longest row, here and of all rows to come
  explicit RowSums(int columns) : longest_(columns) {}

  /// Sums by column, and the columns in the order in which they came first. Between rows all sums are 0, so that a new
  /// column is told from its sum and adding is without a branch: one that cannot be predicted costs as much as five
  /// additions. Where a sum was 0 in between, its column is listed again, and is 0 when it is taken again.
  class Row {
   public:
    /// @pre make_room() for it
    void add(int column, Scalar value) {
      const Scalar before = sums_[column];
      columns_[size_] = column;
      size_ += before == 0;
      sums_[column] = before + value;
    }

    int size() const { return size_; }
    int column(int k) const { return columns_[k]; }
    /// The sum of column(k), which it leaves at 0. Every column has to be taken before the next row.
    Scalar take(int k) {
      Scalar& sum = sums_[columns_[k]];
      const Scalar value = sum;
      sum = 0;
      return value;
    }

   private:
    friend RowSums;
    explicit Row(RowSums& room) : sums_(room.sums_.data()), columns_(room.columns_.data()) {}
    Scalar* sums_;
    int* columns_;
    int size_ = 0;
  };

  /// Room for so many more contributions to a row.
  void make_room(Row& row, int contributions) {
    if (row.size_ + contributions < static_cast<int>(columns_.size())) return;
    columns_.resize(2 * (row.size_ + contributions) + 1);
    row.columns_ = columns_.data();
  }

  /// An empty row. A value and not a part of this, so that it can be held in registers.
  Row next() {
    if (sums_.empty()) {  // here and not before, by the thread that will use it
      sums_.resize(longest_);
      std::fill(sums_.begin(), sums_.end(), Scalar{0});
    }
    return Row(*this);
  }

 private:
  int longest_;
  Array<Scalar> sums_;
  Array<int> columns_;  // one longer than what there is room for, as add() writes before it knows
};

}  // namespace holomorph::solver
