#include "solver/multigrid/coarsening.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
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

// A connection is strong from this part of a vertex's largest weight on: across a stretched mesh the error is smooth
// only along its strong edges.
constexpr float kStrong = 0.2F;

// Neighbours whose weight is at most this part of the largest one are left out of the mean at a vertex.
constexpr float kWeak = 0.1F;
// Weights of P but the largest are multiples of the inverse; half of single precision is left for sums of them.
constexpr int kWeightSteps = 1 << 20;
// C-neighbours of an F-point, those of largest weight, that count for the vertices around it.
constexpr int kCNeighbours = 3;

// The largest of weights >= 0 and their vertices, the lower vertex among equals whatever the order in which they come.
// One number stands for both, so that sorting is without branches: the bits of a weight in the order of the weights,
// and below them the vertex, from the last on.
template <int N>
class Largest {
 public:
  void add(int vertex, float weight) {
    auto key = std::uint64_t{std::bit_cast<std::uint32_t>(weight)} << 32 | (kLast - static_cast<std::uint32_t>(vertex));
    for (std::uint64_t& place : keys_) {
      const std::uint64_t lower = std::min(place, key);
      place = std::max(place, key);
      key = lower;
    }
  }
  // The k-th, from 0; weight 0 beyond the last.
  int vertex(int k) const { return static_cast<int>(kLast - static_cast<std::uint32_t>(keys_[k])); }
  float weight(int k) const { return std::bit_cast<float>(static_cast<std::uint32_t>(keys_[k] >> 32)); }

 private:
  static constexpr std::uint32_t kLast = 0x7FFFFFFF;
  std::array<std::uint64_t, N> keys_{};
};

// The C-neighbours of an F-point, or a C-point itself with weight 1: half a cache line. A missing one has weight 0, so
// that loops over all of them are without branches.
struct alignas(32) CNeighbours {
  std::array<int, kCNeighbours> vertex;
  std::array<float, kCNeighbours> weight;
  float total;  // sum of the weights
  float is_F;   // 1 for an F-point, 0 for a C-point
};

// Whether the value at j may stand for that at i: that of a fixed vertex is a mean of fixed ones alone.
bool may_follow(const Operator& fine, int i, int j) { return !fine.is_fixed(i) || fine.is_fixed(j); }

// None is without C-neighbours: it is an F-point because of one.
CNeighbours neighbours_of_F_point(const Operator& fine, const Array<int>& coarse, int i) {
  Largest<kCNeighbours> nearest;
  for (const auto [j, w] : fine.A[i]) {
    const bool follows = may_follow(fine, i, j);
    const bool counts = (coarse[j] >= 0) & (w > 0) & follows;
    nearest.add(counts ? coarse[j] : 0, counts ? w : 0.0F);
  }
  CNeighbours result{{}, {}, 0, 1};
  for (int k = 0; k < kCNeighbours; ++k) {
    result.weight[k] = nearest.weight(k);
    result.vertex[k] = nearest.weight(k) > 0 ? nearest.vertex(k) : nearest.vertex(0);
    result.total += nearest.weight(k);
  }
  return result;
}

Array<CNeighbours> c_neighbours(const Operator& fine, const Array<int>& coarse, Execution& execution) {
  Array<CNeighbours> result(coarse.size());
  for_row_chunks(fine.A.size(), execution, [&](int, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int c = coarse[i];
      result[i] = c >= 0 ? CNeighbours{{c, c, c}, {1, 0, 0}, 1, 0} : neighbours_of_F_point(fine, coarse, i);
    }
  });
  return result;
}

// The sums divided by their total, made exact.
template <int Most>
void write_row(const Largest<Most>& sums, Entry* row) {
  float total = 0;
  for (int k = 0; k < Most; ++k) total += sums.weight(k);
  const float scale = kWeightSteps / total;
  int left = kWeightSteps;
  for (int k = 1; k < Most; ++k) {
    const int steps = static_cast<int>(sums.weight(k) * scale + 0.5F);
    row[k] = {steps > 0 ? sums.vertex(k) : sums.vertex(0), static_cast<float>(steps) / kWeightSteps};
    left -= steps;
  }
  // The largest weight takes what rounding leaves, so that the row sums to 1 exactly.
  row[0] = {sums.vertex(0), static_cast<float>(left) / kWeightSteps};
}

template <int Most>
EqualRows interpolation_rows(const Operator& fine, const Coarsening& coarse, Execution& execution) {
  const Array<CNeighbours> neighbours = c_neighbours(fine, coarse.number, execution);
  std::vector<SparseAccumulator<float>> accumulators(execution.threads(), SparseAccumulator<float>(coarse.count));
  EqualRows P{Most, Array<Entry>(std::size_t{Most} * coarse.number.size())};
  const auto write_F_point = [&](SparseAccumulator<float>& sums, int i, Entry* row) {
    sums.reserve(kCNeighbours * fine.A[i].size());
    for (const auto [j, w] : fine.A[i]) {
      if (w <= kWeak * fine.largest[i] || !may_follow(fine, i, j)) continue;
      const CNeighbours& next = neighbours[j];
      // Extended+i: an F-neighbour j is replaced by (w x_i + sum_k w_jk x_k) / (w + sum_k w_jk). The part of x_i goes
      // to the left side, and scaling the row to 1 accounts for it. A C-neighbour stands for itself.
      const float part = w / (next.is_F * w + next.total);
      for (int k = 0; k < kCNeighbours; ++k) sums.add(next.vertex[k], part * next.weight[k]);
    }
    Largest<Most> kept;
    sums.take([&kept](int column, float sum) { kept.add(column, sum); });
    write_row(kept, row);
  };
  for_row_chunks(fine.A.size(), execution, [&](int thread, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Entry* const row = P.entries.data() + std::size_t{Most} * i;
      if (const int c = coarse.number[i]; c >= 0) {
        for (int k = 0; k < Most; ++k) row[k] = {c, k == 0 ? 1.0F : 0.0F};
      } else {
        write_F_point(accumulators[thread], i, row);
      }
    }
  });
  return P;
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

Coarsening coarsening(const Operator& fine) {
  constexpr int kUndecided = -2, kFPoint = -1;
  const int n = fine.A.size();
  Coarsening result{Array<int>(n)};
  Array<int>& number = result.number;
  std::fill(number.begin(), number.end(), kUndecided);
  for (int i = 0; i < n; ++i) {
    if (number[i] == kFPoint) continue;
    // An undecided vertex becomes a C-point. Its strong neighbours that are undecided can interpolate from it, and
    // become F-points.
    number[i] = result.count++;
    for (const auto [j, w] : fine.A[i]) {
      // without branches, which could not be predicted
      const bool strong = (w > 0) & (w >= kStrong * fine.largest[j]);
      const bool may_follow = fine.is_fixed(i) || !fine.is_fixed(j);
      const bool becomes_F = strong & (number[j] == kUndecided) & may_follow;
      number[j] = becomes_F ? kFPoint : number[j];
    }
  }
  return result;
}

EqualRows interpolation(const Operator& fine, const Coarsening& coarse, int most, Execution& execution) {
  return most == 2 ? interpolation_rows<2>(fine, coarse, execution) : interpolation_rows<3>(fine, coarse, execution);
}

}  // namespace holomorph::solver
