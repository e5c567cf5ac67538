#include "solver/multigrid/vertex_order.h"

#include <cstdint>

#include "base/chunks.h"

namespace holomorph::solver {
namespace {

// The largest size at which a block of 8 right-hand sides fits into 1 MB, and any order will do.
constexpr int kCached = 32'768;
// An entry is far from a row where it is further than this from all entries of the row: another page of memory.
constexpr int kFar = 256;
// An order is scattered where more than this part of the entries is far. A random order has nearly all, an order along
// a curve or by slices a tenth at most.
constexpr double kMostFar = 0.5;
// One chunk of rows in this number is looked at, as all say the same.
constexpr int kSampled = 8;

// Entries of row i further than kFar from every entry of row i-1.
int far_entries(const Laplacian& L, int i) {
  const int *const start = L.starts.data(), *const column = L.columns.data();
  int count = 0;
  int before = start[i - 1];
  for (int e = start[i]; e < start[i + 1]; ++e) {
    // columns ascend: of the row before, the last entry that is not beyond this one and the first that is
    while (before < start[i] && column[before] <= column[e]) ++before;
    const bool near_last = before > start[i - 1] && column[e] - column[before - 1] <= kFar;
    const bool near_first = before < start[i] && column[before] - column[e] <= kFar;
    count += !near_last && !near_first;
  }
  return count;
}

}  // namespace

bool is_scattered(const Laplacian& L) {
  if (L.size() <= kCached) return false;
  std::int64_t far = 0, all = 0;
  for (int begin = 0; begin + kChunk <= L.size(); begin += kSampled * kChunk) {
    for (int i = begin + 1; i < begin + kChunk; ++i) {
      far += far_entries(L, i);
      all += L.starts[i + 1] - L.starts[i];
    }
  }
  return static_cast<double>(far) > kMostFar * static_cast<double>(all);
}

std::vector<int> breadth_first_order(const Laplacian& L, Execution& execution) {
  const int n = L.size();
  std::vector<int> order;
  order.reserve(n);
  std::vector<char> seen(n, 0);
  for (int first = 0; first < n; ++first) {
    if (seen[first] != 0) continue;
    seen[first] = 1;
    order.push_back(first);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      if (next % kChunk == 0) execution.report(0);
      const int i = order[next];
      for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) {
        const int j = L.columns[e];
        if (seen[j] == 0) order.push_back(j);
        seen[j] = 1;
      }
    }
  }
  return order;
}

// Row by row of the given matrix in the new order, each entry is appended to the row of the other end: ascending
// without sorting, as the matrix is symmetric.
Laplacian renumbered(const Laplacian& L, const std::vector<int>& order) {
  const int n = L.size();
  std::vector<int> number(n), end(n);
  for (int i = 0; i < n; ++i) number[order[i]] = i;
  Laplacian result{Array<int>(n + 1), Array<int>(L.columns.size()), Array<double>(L.weights.size())};
  result.starts[0] = 0;
  for (int i = 0; i < n; ++i) {
    end[i] = result.starts[i];
    result.starts[i + 1] = end[i] + L.starts[order[i] + 1] - L.starts[order[i]];
  }
  for (int j = 0; j < n; ++j) {
    for (int e = L.starts[order[j]]; e < L.starts[order[j] + 1]; ++e) {
      const int place = end[number[L.columns[e]]]++;
      result.columns[place] = j;
      result.weights[place] = L.weights[e];
    }
  }
  return result;
}

}  // namespace holomorph::solver
