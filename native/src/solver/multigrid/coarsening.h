// One step of coarsening: which vertices are C-points, on the coarse level as well, and which are F-points.
#pragma once

#include <span>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::solver {

// Sparse matrices in single precision, and loops over their rows.

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

/// The operator of a level: (A x)_i = sum_j w_ij (x_i - x_j), n x n. It is kept and applied as differences, never with
/// a diagonal. In single precision, rows with a stored diagonal do not sum to 0, an error that drowns smooth functions.
struct Operator {
  SparseRows A;          ///< off-diagonal weights w_ij = -a_ij, of any signs
  Array<float> omega;    ///< n, the smoother's step: x += omega (r - A x); negative at a fixed vertex
  Array<float> largest;  ///< n: max_j w_ij, or 0 where none is positive
  Array<char> fixed;     ///< n: whether the vertex is fixed; empty where none is

  bool is_fixed(int i) const { return !fixed.empty() && fixed[i] != 0; }
};

struct Coarsening {
  Array<int> number;  ///< n: number of a C-point on the coarse level, in the same order; -1 for an F-point
  int count = 0;      ///< number of C-points
};

/// Classical coarsening (Ruge & Stuben 1987, doi:10.1137/1.9781611971057.ch4) by a maximal independent set. In the
/// order of the vertices each undecided one becomes a C-point. Its undecided neighbours j with w_ij >= 0.2 max_k w_jk
/// become F-points. A fixed vertex becomes an F-point only because of a fixed one, so that fixed vertices are coarsened
/// among themselves.
/// Cost: linear, one thread.
Coarsening coarsening(const Operator& fine);

/// P, n x #C: extended+i interpolation (De Sterck, Falgout, Nolting & Yang 2008, doi:10.1002/nla.559). The value at an
/// F-point i is a mean over its neighbours. A neighbour that is an F-point is replaced by a mean over its own
/// C-neighbours and i. The sum is solved for the value at i. Only positive weights are used, and only the `most`
/// largest entries of the result are kept.
///
/// Every row sums to 1 exactly: all weights but the largest are multiples of 2^-20. Then constants are interpolated
/// exactly, and the rounding of a large weight of a sliver does not become a coupling on the coarse level. The row of a
/// fixed vertex has entries at fixed ones alone. So a coarse function that is 0 at the fixed vertices is 0 there on the
/// fine level, too. P^T A P without their rows and columns is the coarse operator of A without them.
/// @param most 2 or 3
/// @throws std::bad_alloc, Cancelled
/// Cost: linear, in parallel.
EqualRows interpolation(const Operator& fine, const Coarsening& coarse, int most, Execution& execution);

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
