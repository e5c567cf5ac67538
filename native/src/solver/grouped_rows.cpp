#include "solver/grouped_rows.h"

namespace holomorph::solver {

GroupedRows::GroupedRows(const SparseRows& M, const Chunks& rows, int chunks, Workers& workers)
    : entry_(M.column.size()), row_(M.size()), first_{0} {
  std::vector<std::vector<Group>> parts(chunks);
  run_throwing(workers, chunks, [&](int chunk) { parts[chunk] = group(M, rows.begin(chunk), rows.end(chunk)); });
  for (const auto& part : parts) {
    groups_.insert(groups_.end(), part.begin(), part.end());
    first_.push_back(static_cast<int>(groups_.size()));
  }
}

// Sorts the rows begin .. end-1 by their length, in place of the same rows.
std::vector<GroupedRows::Group> GroupedRows::group(const SparseRows& M, int begin, int end) {
  const auto length = [&](int i) { return M.start[i + 1] - M.start[i]; };
  std::vector<Group> of_length;
  for (int i = begin; i < end; ++i) {
    while (length(i) >= static_cast<int>(of_length.size()))
      of_length.push_back({static_cast<int>(of_length.size()), 0, 0, 0});
    ++of_length[length(i)].end;
  }
  int row = begin, entry = M.start[begin];
  std::vector<Group> groups;
  for (Group& group : of_length) {
    const int count = group.end;
    group = {group.length, row, row, entry};
    if (count > 0) groups.push_back({group.length, row, row + count, entry});
    row += count;
    entry += count * group.length;
  }
  for (int i = begin; i < end; ++i) {
    Group& group = of_length[length(i)];
    row_[group.end++] = i;
    for (int e = M.start[i]; e < M.start[i + 1]; ++e) entry_[group.entries++] = {M.column[e], M.weight[e]};
  }
  return groups;
}

}  // namespace holomorph::solver
