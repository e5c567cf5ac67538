// Sums up a sparse row from contributions in any order.
#pragma once

#include <vector>

namespace holomorph::solver {

/// Sums by column, and the columns in the order in which they came first. Between rows all sums are 0, so a sum tells
/// whether its column is new. Adding needs no branch, which could not be predicted. Where a sum was 0 in between, its
/// column is listed again, and is 0 when it is taken again. One per thread, aligned so that no two are on one cache
/// line.
template <class Scalar>
class alignas(128) SparseAccumulator {
 public:
  explicit SparseAccumulator(int columns) : sums_(columns, Scalar{0}) {}

  /// Reserves room for this many more contributions to the row.
  void reserve(std::size_t contributions) {
    // one more, as add() writes before it knows
    if (size_ + contributions >= columns_.size()) columns_.resize(2 * (size_ + contributions) + 1);
  }
  /// @pre reserve() for it
  void add(int column, Scalar value) {
    const Scalar before = sums_[column];
    columns_[size_] = column;
    size_ += before == 0;
    sums_[column] = before + value;
  }

  /// each(column, sum) for all columns; the row is empty afterwards.
  template <class Each>
  void take(const Each& each) {
    for (std::size_t k = 0; k < size_; ++k) {
      const int column = columns_[k];
      const Scalar sum = sums_[column];
      sums_[column] = 0;
      each(column, sum);
    }
    size_ = 0;
  }

 private:
  std::vector<Scalar> sums_;
  std::vector<int> columns_;
  std::size_t size_ = 0;
};

}  // namespace holomorph::solver
