#include "solver/multigrid/sparse_rows.h"

#include <algorithm>
#include <numeric>

namespace holomorph::solver {
namespace {

// The rows begin .. end - 1, the shortest first, by counting.
void sort_by_length(const SparseRows& M, int begin, int end, int* order) {
  std::vector<int> next;  // place of the next row of each length
  for (int i = begin; i < end; ++i) {
    next.resize(std::max(next.size(), M[i].size() + 2), 0);
    ++next[M[i].size() + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (int i = begin; i < end; ++i) order[next[M[i].size()]++] = i;
}

}  // namespace

SparseRows joined(Array<int>&& ends, const std::vector<std::vector<Entry>>& parts, Execution& execution) {
  std::vector<int> first(parts.size() + 1, 0);
  for (std::size_t c = 0; c < parts.size(); ++c) first[c + 1] = first[c] + static_cast<int>(parts[c].size());
  const std::size_t rows = ends.size();
  SparseRows result{Array<int>(rows), std::move(ends), Array<Entry>(first.back()), Array<int>(rows)};
  for_row_chunks(result.size(), execution, [&](int, int chunk, int begin, int end) {
    for (int i = begin; i < end; ++i) result.starts[i] = i == begin ? 0 : result.ends[i - 1];
    sort_by_length(result, begin, end, result.order.data() + begin);
    int at = first[chunk];
    for (int k = begin; k < end; ++k) {
      int &start = result.starts[result.order[k]], &stop = result.ends[result.order[k]];
      std::copy(parts[chunk].begin() + start, parts[chunk].begin() + stop, result.entries.begin() + at);
      stop += at - start;
      start = at;
      at = stop;
    }
  });
  return result;
}

SparseRows transposed(const EqualRows& M, int columns) {
  SparseRows R{Array<int>(columns), {}, {}, {}};
  std::fill(R.starts.begin(), R.starts.end(), 0);
  for (const Entry& entry : M.entries) R.starts[entry.column] += entry.weight != 0;
  R.entries.resize(std::accumulate(R.starts.begin(), R.starts.end(), std::size_t{0}));
  std::exclusive_scan(R.starts.begin(), R.starts.end(), R.starts.begin(), 0);
  R.ends = R.starts;
  for (int i = 0; i < M.size(); ++i) {
    for (int k = 0; k < M.each; ++k) {
      if (M[i][k].weight != 0) R.entries[R.ends[M[i][k].column]++] = {i, M[i][k].weight};
    }
  }
  return R;
}

}  // namespace holomorph::solver
