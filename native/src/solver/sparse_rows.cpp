#include "solver/sparse_rows.h"

#include <numeric>

namespace holomorph::solver {
namespace {

// Columns that one thread transposes at a time.
constexpr int kColumns = 4096;

// The least and the largest column of the rows of every chunk.
struct ColumnRanges {
  std::vector<int> least, most;

  ColumnRanges(const EqualRows& M, Workers& workers, Execution& execution)
      : least(wave_chunks(M.size())), most(wave_chunks(M.size())) {
    for_set_up_chunks(workers, M.size(), execution, [&](int, int chunk, int begin, int end) {
      int low = M[begin]->column, high = low;
      for (const Entry* e = M[begin]; e != M[end]; ++e) {
        low = std::min(low, e->column);
        high = std::max(high, e->column);
      }
      least[chunk] = low;
      most[chunk] = high;
    });
  }
};

// visit(row, entry) for the entries of M in the columns begin .. end-1, row by row, the last entry of each first.
template <class Visit>
void for_columns(const EqualRows& M, const ColumnRanges& ranges, int begin, int end, const Visit& visit) {
  for (int chunk = 0; chunk < static_cast<int>(ranges.least.size()); ++chunk) {
    if (ranges.most[chunk] < begin || ranges.least[chunk] >= end) continue;
    const int first = chunk * kWaveRows, last = std::min(first + kWaveRows, M.size());
    for (int i = first; i < last; ++i) {
      for (int k = M.each; k-- > 0;) {
        const Entry& entry = M[i][k];
        if (entry.column >= begin && entry.column < end) visit(i, entry);
      }
    }
  }
}

// Calls body(begin, end) for blocks of columns, in parallel.
template <class Body>
void for_column_blocks(int columns, Workers& workers, Execution& execution, const Body& body) {
  // One thread has nothing to share; and where columns are anywhere, more blocks would be more passes.
  const int blocks = workers.count() == 1 ? 1 : std::min(columns / kColumns + 1, 8 * workers.count());
  const int width = (columns + blocks - 1) / blocks;
  execution.report(0);
  workers.run(blocks, [&](int, int b) { body(std::min(b * width, columns), std::min((b + 1) * width, columns)); });
}

}  // namespace

// Each block of columns is done by one thread, which looks through the chunks that have entries in it.
SparseRows transposed(const EqualRows& M, int columns, int chunks, Workers& workers, Execution& execution) {
  const ColumnRanges ranges(M, workers, execution);
  Array<int> start(columns + std::size_t{1});  // of every row, if they followed each other
  start[0] = 0;
  for_column_blocks(columns, workers, execution, [&](int begin, int end) {
    std::fill(start.begin() + begin + 1, start.begin() + end + 1, 0);
    for_columns(M, ranges, begin, end, [&](int, const Entry& entry) { start[entry.column + 1] += entry.weight != 0; });
  });
  std::partial_sum(start.begin(), start.end(), start.begin());
  SparseRows R{GroupedRows(columns, chunks), Array<SparseRows::Place>(columns)};
  R.rows.entries().resize(start[columns]);
  const Chunks rows{columns, (columns + chunks - 1) / chunks};
  run_throwing(workers, chunks, [&](int chunk) {
    const int begin = rows.begin(chunk), count = rows.end(chunk) - begin;
    R.rows.lay_out(chunk, begin, {start.data() + begin, count + std::size_t{1}}, start[begin]);
    int next = start[begin];
    R.rows.for_rows(chunk, [&](int c, const Entry*, int length) {
      R.place[c] = {next, next};
      next += length;
    });
  });
  Entry* const entries = R.rows.entries().data();
  for_column_blocks(columns, workers, execution, [&](int begin, int end) {
    // A zero has the column of the first entry of its row, which comes later and overwrites it.
    for_columns(M, ranges, begin, end, [&](int i, const Entry& entry) {
      int& next = R.place[entry.column].end;
      entries[next] = {i, entry.weight};
      next += entry.weight != 0;
    });
  });
  return R;
}

}  // namespace holomorph::solver
