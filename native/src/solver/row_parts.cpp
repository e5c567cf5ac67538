#include "solver/row_parts.h"

namespace holomorph::solver {

CollectedRows::CollectedRows(int rows, std::size_t expected_entries)
    : matrix_{GroupedRows(rows, wave_chunks(rows)), Array<SparseRows::Place>(rows)} {
  matrix_.rows.entries().resize(expected_entries);
}

void CollectedRows::add(int chunk, const RowPart& part) {
  std::size_t first;
  {
    const std::lock_guard lock(mutex_);
    if (used_ + part.size > matrix_.rows.entries().size()) {
      beyond_.emplace_back(chunk, part);
      return;
    }
    first = used_;
    used_ += part.size;
  }
  put(chunk, part, first);
}

void CollectedRows::put(int chunk, const RowPart& part, std::size_t first) {
  const int begin = chunk * kWaveRows;
  auto next = static_cast<int>(first);
  matrix_.rows.lay_out(chunk, begin, part.offsets, next);
  Entry* const entries = matrix_.rows.entries().data();
  matrix_.rows.for_rows(chunk, [&](int i, const Entry*, int length) {
    std::copy_n(part.entry.data() + part.offsets[i - begin], length, entries + next);
    matrix_.place[i] = {next, next + length};
    next += length;
  });
}

SparseRows CollectedRows::result() {
  std::size_t all = used_;
  for (const auto& [chunk, part] : beyond_) all += part.size;
  matrix_.rows.entries().resize(all);
  for (const auto& [chunk, part] : beyond_) {
    put(chunk, part, used_);
    used_ += part.size;
  }
  return std::move(matrix_);
}

}  // namespace holomorph::solver
