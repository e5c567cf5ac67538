#include "solver/grouped_rows.h"

namespace holomorph::solver {

// Sorting by counting.
void GroupedRows::lay_out(int chunk, int begin, std::span<const int> offsets, int first) {
  const int rows = static_cast<int>(offsets.size()) - 1;
  int most = 0;
  for (int k = 0; k < rows; ++k) most = std::max(most, offsets[k + 1] - offsets[k]);
  std::vector<int> next(most + 1, 0);
  for (int k = 0; k < rows; ++k) ++next[offsets[k + 1] - offsets[k]];
  std::vector<Group>& groups = groups_[chunk];
  int row = begin;
  for (int length = 0; length <= most; ++length) {
    const int count = next[length];
    if (count > 0) groups.push_back({length, row, row + count, first});
    next[length] = row;
    row += count;
    first += count * length;
  }
  for (int k = 0; k < rows; ++k) row_[next[offsets[k + 1] - offsets[k]]++] = begin + k;
}

std::span<const Entry> GroupedRows::of_chunk(int chunk) const {
  if (groups_[chunk].empty()) return {};
  const Group &first = groups_[chunk].front(), &last = groups_[chunk].back();
  const int end = last.entries + last.length * (last.end - last.begin);
  return {entry_.data() + first.entries, static_cast<std::size_t>(end - first.entries)};
}

std::vector<int> needs_of(const GroupedRows& M, int chunk, int chunks) {
  std::vector<char> found(chunks, 0);
  std::vector<int> needs;
  for (const Entry& entry : M.of_chunk(chunk)) {
    const unsigned need = static_cast<unsigned>(entry.column) / kWaveRows;
    if (found[need] != 0) continue;
    found[need] = 1;
    needs.push_back(static_cast<int>(need));
  }
  return needs;
}

}  // namespace holomorph::solver
