// Sparse matrices in single precision while the hierarchy is set up.
#pragma once

#include "base/execution.h"
#include "solver/equal_rows.h"
#include "solver/grouped_rows.h"

namespace holomorph::solver {

/// A matrix whose rows are found by their numbers as well, in chunks of kWaveRows if not said otherwise.
struct SparseRows {
  struct Place {
    int begin, end;  // of the row's entries
  };
  GroupedRows rows;
  Array<Place> place;

  int size() const { return static_cast<int>(place.size()); }
  /// In a fixed order of no meaning.
  std::span<const Entry> operator[](int i) const {
    return {rows.entries().data() + place[i].begin, rows.entries().data() + place[i].end};
  }
};

/// body(thread, chunk, begin, end) for the rows begin .. end-1 of every chunk of kWaveRows, in parallel; asks
/// `execution` between batches of some 10 ms, so that cancelling is answered soon. Throws what the first body threw.
template <class Body>
void for_set_up_chunks(Workers& workers, int rows, Execution& execution, const Body& body) {
  constexpr int kBatch = 256;
  for (int first = 0; first < wave_chunks(rows); first += kBatch) {
    execution.report(0);
    run_throwing(workers, std::min(kBatch, wave_chunks(rows) - first), [&](int thread, int c) {
      const int begin = (first + c) * kWaveRows;
      body(thread, first + c, begin, std::min(begin + kWaveRows, rows));
    });
  }
}

/// The transpose, without zeros, its rows in as many chunks of equal size; entries of a row in ascending order.
/// Cost: two passes over the entries, in parallel where the columns of neighbouring rows are near each other.
SparseRows transposed(const EqualRows& M, int columns, int chunks, Workers& workers, Execution& execution);

}  // namespace holomorph::solver
