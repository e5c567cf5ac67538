#include "solver/interpolation.h"

#include <array>
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
constexpr int kStaying = 3;

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

// The staying neighbours of a vertex that goes, or a vertex that stays with weight 1: half a cache line. A missing one
// has weight 0, so that loops over all of them are without branches.
struct alignas(32) Staying {
  std::array<int, kStaying> vertex;
  std::array<float, kStaying> weight;
  float total;  // of the weights
  float goes;   // 1, or 0 for a vertex that stays
};

// Calls body(i, entries, length) for the rows of a chunk whose vertices go; which these are cannot be predicted, so
// that they are listed first.
template <class Body>
void for_going(const SparseRows& A, const Array<int>& coarse, int chunk, const Body& body) {
  struct Row {
    int i, length;
    const Entry* entries;
  };
  std::array<Row, kWaveRows + 1> going;
  int count = 0;
  A.rows.for_rows(chunk, [&](int i, const Entry* entries, int length) {
    going[count] = {i, length, entries};
    count += coarse[i] < 0;
  });
  for (int k = 0; k < count; ++k) body(going[k].i, going[k].entries, going[k].length);
}

// None that goes is without a staying neighbour: it goes because of one.
Array<Staying> staying_neighbours(const SparseRows& A, const Array<char>& held, const Array<int>& coarse,
                                  Workers& workers, Execution& execution) {
  Array<Staying> result(A.size());
  for_set_up_chunks(workers, A.size(), execution, [&](int, int chunk, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      result[i] = {{coarse[i], coarse[i], coarse[i]}, {1, 0, 0}, 1, 0};
    }
    for_going(A, coarse, chunk, [&](int i, const Entry* entries, int length) {
      Largest<kStaying> nearest;
      for (int e = 0; e < length; ++e) {
        const auto [j, w] = entries[e];
        const int c = coarse[j];
        const bool counts = (c >= 0) & (w > 0) & !(is_held(held, i) && !is_held(held, j));
        nearest.add(counts ? c : 0, counts ? w : 0.0F);
      }
      Staying staying{{}, {}, 0, 1};
      for (int k = 0; k < kStaying; ++k) {
        staying.weight[k] = nearest.weight(k);
        staying.vertex[k] = nearest.weight(k) > 0 ? nearest.vertex(k) : nearest.vertex(0);
        staying.total += nearest.weight(k);
      }
      result[i] = staying;
    });
  });
  return result;
}

// The sums divided by their total, made exact.
template <int Most>
void write_mean(const Largest<Most>& sums, Entry* mean) {
  float total = 0;
  for (int k = 0; k < Most; ++k) total += sums.weight(k);
  const float scale = kWeightSteps / total;
  int rest = kWeightSteps;
  for (int k = 1; k < Most; ++k) {
    const int steps = static_cast<int>(sums.weight(k) * scale + 0.5F);
    mean[k] = {steps > 0 ? sums.vertex(k) : sums.vertex(0), static_cast<float>(steps) / kWeightSteps};
    rest -= steps;
  }
  mean[0] = {sums.vertex(0), static_cast<float>(rest) / kWeightSteps};
}

template <int Most>
EqualRows means(const SparseRows& A, const Array<float>& largest, const Array<char>& held, const Array<int>& coarse,
                std::vector<RowSums<float>>& scratch, Workers& workers, Execution& execution) {
  const Array<Staying> staying = staying_neighbours(A, held, coarse, workers, execution);
  EqualRows result{Most, Array<Entry>(std::size_t{Most} * A.size())};
  for_set_up_chunks(workers, A.size(), execution, [&](int thread, int chunk, int begin, int end) {
    RowSums<float>& room = scratch[thread];
    Entry* const mean = result.entry.data();
    for (int i = begin; i < end; ++i) {
      for (int k = 0; k < Most; ++k) mean[std::size_t{Most} * i + k] = {coarse[i], k == 0 ? 1.0F : 0.0F};
    }
    for_going(A, coarse, chunk, [&](int i, const Entry* entries, int length) {
      RowSums<float>::Row sums = room.next();
      room.make_room(sums, kStaying * length);
      const float weak = kWeak * largest[i];
      for (int e = 0; e < length; ++e) {
        const auto [j, w] = entries[e];
        if (w <= weak || (is_held(held, i) && !is_held(held, j))) continue;
        const Staying& next = staying[j];
        const float part = w / (next.goes * w + next.total);
        for (int k = 0; k < kStaying; ++k) sums.add(next.vertex[k], part * next.weight[k]);
      }
      Largest<Most> kept;
      for (int k = 0; k < sums.size(); ++k) kept.add(sums.column(k), sums.take(k));
      write_mean(kept, mean + std::size_t{Most} * i);
    });
  });
  return result;
}

}  // namespace

Coarsening coarsening(const SparseRows& A, const Array<float>& largest, const Array<char>& held) {
  constexpr int kUndecided = -2, kGoes = -1;
  Coarsening result{Array<int>(A.size())};
  Array<int>& number = result.number;
  std::fill(number.begin(), number.end(), kUndecided);
  for (int i = 0; i < A.size(); ++i) {
    if (number[i] == kGoes) continue;
    number[i] = result.count++;
    for (const auto [j, w] : A[i]) {
      const bool strong = (w > 0) & (w >= kStrong * largest[j]);
      const bool goes = strong & (number[j] == kUndecided) & (is_held(held, i) || !is_held(held, j));
      number[j] = goes ? kGoes : number[j];
    }
  }
  return result;
}

EqualRows interpolation(const SparseRows& A, const Array<float>& largest, const Array<char>& held,
                        const Array<int>& coarse, int most, std::vector<RowSums<float>>& scratch, Workers& workers,
                        Execution& execution) {
  const auto by_most = most == 2 ? means<2> : means<3>;
  return by_most(A, largest, held, coarse, scratch, workers, execution);
}

}  // namespace holomorph::solver
