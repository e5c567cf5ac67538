#include "solver/renumbering.h"

#include <cstdint>
#include <numeric>

namespace holomorph::solver {
namespace {

// Up to here a block of 8 right-hand sides is 1 MB.
constexpr int kCached = 32'768;
// An entry is far from a row where it is further than this from all entries of the row: another page of memory.
constexpr int kFar = 256;
// Of all entries of a matrix. A random order has nearly all, an order along a curve or by slices a tenth at most.
constexpr double kMostFar = 0.5;
// One chunk of rows in so many is looked at: all say the same.
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

bool is_scattered(const Laplacian& L, Workers& workers) {
  const int n = L.size();
  if (n <= kCached) return false;
  const int sampled = chunk_count(n) / kSampled;
  std::vector<std::int64_t> far(sampled, 0), all(sampled, 0);
  workers.run(sampled, [&](int, int c) {
    const int begin = c * kSampled * kChunk, end = begin + kChunk;
    std::int64_t count = 0;
    for (int i = begin + 1; i < end; ++i) count += far_entries(L, i);
    far[c] = count;
    all[c] = L.starts[end] - L.starts[begin + 1];
  });
  const auto total = [](const auto& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  };
  return total(far) > kMostFar * total(all);
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
