#include "solver/interpolation.h"

#include <bit>

namespace holomorph::solver {
namespace {

// A vertex goes only along a weight of at least this part of its largest: across a stretched mesh the error is smooth
// only along its strong edges. Between 0.1 and 0.35 the time is the same.
constexpr float kStrong = 0.2F;
// Neighbours of at most this part of the largest weight say nothing about the value at a vertex.
constexpr float kWeak = 0.1F;
// Weights of P but the largest are multiples of this; half of single precision is left for sums of them.
constexpr int kWeightSteps = 1 << 20;
// Of the staying neighbours of a vertex that goes, so many of largest weight count for the vertices around it.
constexpr int kStaying = 4;

bool is_held(const Array<char>& held, int i) { return !held.empty() && held[i] != 0; }

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
  // The k-th, from 0; of weight 0 beyond the last.
  int vertex(int k) const { return static_cast<int>(kLast - static_cast<std::uint32_t>(keys_[k])); }
  float weight(int k) const { return std::bit_cast<float>(static_cast<std::uint32_t>(keys_[k] >> 32)); }

 private:
  static constexpr std::uint32_t kLast = 0x7FFFFFFF;
  std::array<std::uint64_t, N> keys_{};
};

// The staying neighbours of a vertex that goes: half a cache line, whatever their number. A missing one has weight 0.
struct Staying {
  std::array<int, kStaying> vertex;
  std::array<float, kStaying> weight;
};

// For the vertices that go; the others are left unwritten. None is without a staying neighbour: it goes because of one.
Array<Staying> staying_neighbours(const SparseRows& A, const Array<char>& held, const Array<int>& coarse,
                                  Workers& workers, Progress& progress) {
  Array<Staying> result(A.size());
  for_set_up_chunks(workers, A.size(), progress, [&](int, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (coarse[i] >= 0) continue;
      Largest<kStaying> largest;
      for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
        const int j = A.column[e], c = coarse[j];
        const bool counts = c >= 0 && A.weight[e] > 0 && !(is_held(held, i) && !is_held(held, j));
        largest.add(counts ? c : 0, counts ? A.weight[e] : 0.0F);
      }
      for (int k = 0; k < kStaying; ++k) {
        result[i].weight[k] = largest.weight(k);
        result[i].vertex[k] = largest.weight(k) > 0 ? largest.vertex(k) : largest.vertex(0);
      }
    }
  });
  return result;
}

// The sums divided by their total, made exact.
Mean exact_mean(const Largest<kMostMeans>& sums, int most) {
  Mean mean{};
  mean.vertex.fill(sums.vertex(0));
  double total = 0;
  for (int k = 0; k < most; ++k) total += sums.weight(k);
  int rest = kWeightSteps;
  for (int k = 1; k < most; ++k) {
    const int steps = static_cast<int>(sums.weight(k) / total * kWeightSteps + 0.5);
    if (steps > 0) mean.vertex[k] = sums.vertex(k);
    mean.weight[k] = static_cast<float>(steps) / kWeightSteps;
    rest -= steps;
  }
  mean.weight[0] = static_cast<float>(rest) / kWeightSteps;
  return mean;
}

}  // namespace

Array<int> coarse_vertices(const SparseRows& A, const Array<float>& largest, const Array<char>& held,
                           Progress& progress) {
  constexpr int kUndecided = -2, kGoes = -1;
  Array<int> coarse(A.size());
  std::fill(coarse.begin(), coarse.end(), kUndecided);
  int count = 0;
  for (int i = 0; i < A.size(); ++i) {
    if (i % kChunk == 0) progress.report(0);
    if (coarse[i] != kUndecided) continue;
    coarse[i] = count++;
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      const int j = A.column[e];
      if (coarse[j] != kUndecided || A.weight[e] <= 0 || A.weight[e] < kStrong * largest[j]) continue;
      if (is_held(held, i) || !is_held(held, j)) coarse[j] = kGoes;
    }
  }
  return coarse;
}

Array<Mean> interpolation(const SparseRows& A, const Array<float>& largest, const Array<char>& held,
                          const Array<int>& coarse, int most, std::vector<RowSums>& scratch, Workers& workers,
                          Progress& progress) {
  const Array<Staying> staying = staying_neighbours(A, held, coarse, workers, progress);
  const auto sum_up = [&](int i, RowSums::Row& sums) {
    const float weak = kWeak * largest[i];
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      const float w = A.weight[e];
      const int j = A.column[e], c = coarse[j];
      if (w <= weak || (is_held(held, i) && !is_held(held, j))) continue;
      if (c >= 0) {
        sums.add(c, w);
        continue;
      }
      const Staying& next = staying[j];
      const float part = w / (w + ((next.weight[0] + next.weight[1]) + (next.weight[2] + next.weight[3])));
      for (int k = 0; k < kStaying; ++k) sums.add(next.vertex[k], part * next.weight[k]);
    }
  };
  Array<Mean> result(A.size());
  for_set_up_chunks(workers, A.size(), progress, [&](int thread, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (coarse[i] >= 0) {
        result[i] = {{coarse[i], coarse[i], coarse[i]}, {1, 0, 0}};
        continue;
      }
      RowSums::Row sums = scratch[thread].next();
      sum_up(i, sums);
      Largest<kMostMeans> kept;
      for (int k = 0; k < sums.size(); ++k) kept.add(sums.column(k), static_cast<float>(sums.sum(k)));
      result[i] = exact_mean(kept, most);
    }
  });
  return result;
}

SparseRows sparse(const Array<Mean>& P, Workers& workers, Progress& progress) {
  const int n = static_cast<int>(P.size());
  std::vector<int> place(set_up_chunks(n) + 1, 0);
  for_set_up_chunks(workers, n, progress, [&](int, int chunk, int begin, int end) {
    int entries = 0;
    for (int i = begin; i < end; ++i) {
      for (const float weight : P[i].weight) entries += weight != 0;
    }
    place[chunk + 1] = entries;
  });
  for (std::size_t c = 1; c < place.size(); ++c) place[c] += place[c - 1];
  SparseRows rows;
  rows.start.resize(n + std::size_t{1});
  rows.start[0] = 0;
  rows.column.resize(place.back());
  rows.weight.resize(place.back());
  for_set_up_chunks(workers, n, progress, [&](int, int chunk, int begin, int end) {
    int next = place[chunk];
    for (int i = begin; i < end; ++i) {
      for (int k = 0; k < kMostMeans; ++k) {
        if (P[i].weight[k] == 0) continue;
        rows.column[next] = P[i].vertex[k];
        rows.weight[next++] = P[i].weight[k];
      }
      rows.start[i + 1] = next;
    }
  });
  return rows;
}

}  // namespace holomorph::solver
