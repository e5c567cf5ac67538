#include "solver/multigrid/sparse_rows.h"

#include <algorithm>
#include <numeric>

namespace holomorph::solver {

SparseRows joined(Array<int>&& starts, const std::vector<std::vector<Entry>>& parts, Execution& execution) {
  std::vector<int> first(parts.size() + 1, 0);
  for (std::size_t c = 0; c < parts.size(); ++c) first[c + 1] = first[c] + static_cast<int>(parts[c].size());
  SparseRows result{std::move(starts), Array<Entry>(first.back())};
  result.starts[0] = 0;
  for_row_chunks(result.size(), execution, [&](int, int chunk, int begin, int end) {
    std::copy(parts[chunk].begin(), parts[chunk].end(), result.entries.begin() + first[chunk]);
    for (int i = begin; i < end; ++i) result.starts[i + 1] += first[chunk];
  });
  return result;
}

Array<int> rows_by_length(const SparseRows& M, Execution& execution) {
  Array<int> order(M.size());
  for_row_chunks(M.size(), execution, [&](int, int, int begin, int end) {
    std::iota(order.begin() + begin, order.begin() + end, begin);
    std::stable_sort(order.begin() + begin, order.begin() + end,
                     [&](int a, int b) { return M[a].size() < M[b].size(); });
  });
  return order;
}

SparseRows transposed(const EqualRows& M, int columns) {
  SparseRows R;
  R.starts.resize(columns + std::size_t{1});
  std::fill(R.starts.begin(), R.starts.end(), 0);
  for (const Entry& entry : M.entries) R.starts[entry.column + 1] += entry.weight != 0;
  std::partial_sum(R.starts.begin(), R.starts.end(), R.starts.begin());
  R.entries.resize(R.starts.back());
  std::vector<int> next(R.starts.begin(), R.starts.end());
  for (int i = 0; i < M.size(); ++i) {
    for (int k = 0; k < M.each; ++k) {
      if (M[i][k].weight != 0) R.entries[next[M[i][k].column]++] = {i, M[i][k].weight};
    }
  }
  return R;
}

}  // namespace holomorph::solver
