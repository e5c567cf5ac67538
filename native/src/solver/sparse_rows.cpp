#include "solver/sparse_rows.h"

namespace holomorph::solver {
namespace {

// Columns that one thread transposes at a time.
constexpr int kColumns = 4096;

// The least and the largest column of the rows of every chunk.
struct ColumnRanges {
  std::vector<int> least, most;

  ColumnRanges(const SparseRows& M, Workers& workers, Progress& progress)
      : least(set_up_chunks(M.size())), most(set_up_chunks(M.size())) {
    for_set_up_chunks(workers, M.size(), progress, [&](int, int chunk, int begin, int end) {
      const int* const column = M.column.data();
      int low = M.start[begin] < M.start[end] ? column[M.start[begin]] : 0, high = low;
      for (int e = M.start[begin]; e < M.start[end]; ++e) {
        low = std::min(low, column[e]);
        high = std::max(high, column[e]);
      }
      least[chunk] = low;
      most[chunk] = high;
    });
  }
};

// visit(row, entry) for the entries of M in the columns begin .. end-1, row by row.
template <class Visit>
void for_columns(const SparseRows& M, const ColumnRanges& ranges, int begin, int end, const Visit& visit) {
  for (int chunk = 0; chunk < static_cast<int>(ranges.least.size()); ++chunk) {
    if (ranges.most[chunk] < begin || ranges.least[chunk] >= end) continue;
    const int first = chunk * kSetUpChunk, last = std::min(first + kSetUpChunk, M.size());
    for (int i = first; i < last; ++i) {
      for (int e = M.start[i]; e < M.start[i + 1]; ++e) {
        if (M.column[e] >= begin && M.column[e] < end) visit(i, e);
      }
    }
  }
}

}  // namespace

// Each block of columns is done by one thread, which looks through the chunks that have entries in it.
SparseRows transposed(const SparseRows& M, int columns, Workers& workers, Progress& progress) {
  const ColumnRanges ranges(M, workers, progress);
  // One thread has nothing to share; and where columns are anywhere, more blocks would be more passes.
  const int blocks = workers.count() == 1 ? 1 : std::min(columns / kColumns + 1, 8 * workers.count());
  const int width = (columns + blocks - 1) / blocks;
  const auto for_blocks = [&](const auto& body) {
    progress.report(0);
    workers.run(blocks, [&](int, int b) { body(b * width, std::min((b + 1) * width, columns)); });
  };
  SparseRows R;
  R.start.resize(columns + std::size_t{1});
  // start[c + 1]: first the number of entries of row c, then the place of the next one, in the end that of row c + 1.
  R.start[0] = 0;
  for_blocks([&](int begin, int end) {
    for (int c = begin; c < end; ++c) R.start[c + 1] = 0;
    for_columns(M, ranges, begin, end, [&](int, int e) { ++R.start[M.column[e] + 1]; });
  });
  int place = 0;
  for (int c = 0; c < columns; ++c) {
    const int count = R.start[c + 1];
    R.start[c + 1] = place;
    place += count;
  }
  R.column.resize(M.column.size());
  R.weight.resize(M.column.size());
  for_blocks([&](int begin, int end) {
    for_columns(M, ranges, begin, end, [&](int i, int e) {
      const int next = R.start[M.column[e] + 1]++;
      R.column[next] = i;
      R.weight[next] = M.weight[e];
    });
  });
  return R;
}

}  // namespace holomorph::solver
