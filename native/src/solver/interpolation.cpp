#include "solver/interpolation.h"

#include <cmath>

namespace holomorph::solver {
namespace {

// A vertex goes only along a weight of at least this part of its largest: across a stretched mesh the error is smooth
// only along its strong edges. Between 0.1 and 0.35 the time is the same.
constexpr float kStrong = 0.2F;
// Neighbours below this part of the largest weight say nothing about the value at a vertex.
constexpr float kWeak = 0.05F;
// Weights of P but the largest are multiples of this; half of single precision is left for sums of them.
constexpr double kWeightStep = 1.0 / (1 << 20);

bool is_held(const Array<char>& held, int i) { return !held.empty() && held[i] != 0; }

Array<float> largest_weights(const SparseRows& A, Workers& workers) {
  Array<float> largest(A.size());
  for_rows(workers, A.size(), [&](int i) {
    float most = 0;
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) most = std::max(most, A.weight[e]);
    largest[i] = most;
  });
  return largest;
}

// A mean over the coarse vertices; the weights of one vertex are gathered in `sum` (#coarse, else 0).
struct Mean {
  std::vector<double> sum;
  std::vector<int> vertices;

  void add(int coarse, double weight) {
    if (sum[coarse] == 0) vertices.push_back(coarse);
    sum[coarse] += weight;
  }
  // Among equal weights the lower index, whatever the order in which they came.
  void keep(int most) {
    const auto larger = [&](int a, int b) { return sum[a] > sum[b] || (sum[a] == sum[b] && a < b); };
    const auto kept = std::min<std::size_t>(most, vertices.size());
    std::partial_sort(vertices.begin(), vertices.begin() + kept, vertices.end(), larger);
    for (std::size_t i = kept; i < vertices.size(); ++i) sum[vertices[i]] = 0;
    vertices.resize(kept);
  }
  // Appends the weights divided by their sum, made exact, and empties the mean. @pre the largest comes first
  template <class Part>
  void append_to(Part& part) {
    double total = 0, rest = 1;
    for (const int c : vertices) total += sum[c];
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      double& weight = sum[vertices[i]];
      weight = kWeightStep * std::floor(weight / total / kWeightStep + 0.5);
      rest -= weight;
    }
    if (!vertices.empty()) sum[vertices[0]] = rest;
    std::sort(vertices.begin(), vertices.end());
    for (const int c : vertices) {
      if (sum[c] != 0) {
        part.column.push_back(c);
        part.weight.push_back(static_cast<float>(sum[c]));
      }
      sum[c] = 0;
    }
    vertices.clear();
  }
};

// One step of the mean: the staying neighbours of a vertex that goes; a staying vertex itself.
// No row is empty: a vertex goes because of a staying neighbour.
SparseRows staying_neighbours(const SparseRows& A, const Array<char>& held, const Array<int>& coarse, Workers& workers,
                              Progress& progress) {
  const auto no_scratch = [] { return 0; };
  return build_rows(A.size(), 3 * coarse.size(), workers, progress, no_scratch, [&](int, int i, auto& part) {
    if (coarse[i] >= 0) {
      part.column.push_back(coarse[i]);
      part.weight.push_back(1);
      return;
    }
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      const int j = A.column[e], c = coarse[j];
      if (c < 0 || A.weight[e] <= 0 || (is_held(held, i) && !is_held(held, j))) continue;
      part.column.push_back(c);
      part.weight.push_back(A.weight[e]);
    }
  });
}

}  // namespace

Array<int> coarse_vertices(const SparseRows& A, const Array<char>& held, Workers& workers, Progress& progress) {
  constexpr int kUndecided = -2, kGoes = -1;
  const Array<float> largest = largest_weights(A, workers);
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

SparseRows interpolation(const SparseRows& A, const Array<char>& held, const Array<int>& coarse, int coarse_count,
                         int most, Workers& workers, Progress& progress) {
  const SparseRows one_step = staying_neighbours(A, held, coarse, workers, progress);
  const auto scratch = [&] { return Mean{std::vector<double>(coarse_count), {}}; };
  const auto expected = most * (coarse.size() - coarse_count) + coarse_count;
  return build_rows(A.size(), expected, workers, progress, scratch, [&](Mean& mean, int i, auto& part) {
    if (coarse[i] >= 0) {
      part.column.push_back(coarse[i]);
      part.weight.push_back(1);
      return;
    }
    float largest = 0;
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) largest = std::max(largest, A.weight[e]);
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      if (A.weight[e] <= kWeak * largest) continue;
      const int j = A.column[e];
      if (is_held(held, i) && !is_held(held, j)) continue;
      const int begin = one_step.start[j], end = one_step.start[j + 1];
      double total = coarse[j] < 0 ? A.weight[e] : 0;
      for (int s = begin; s < end; ++s) total += one_step.weight[s];
      for (int s = begin; s < end; ++s) mean.add(one_step.column[s], A.weight[e] / total * one_step.weight[s]);
    }
    mean.keep(most);
    mean.append_to(part);
  });
}

SparseRows transposed(const SparseRows& P, int columns, Progress& progress) {
  SparseRows R;
  R.start.assign(columns + 1, 0);
  for (const int c : P.column) ++R.start[c + 1];
  for (int c = 0; c < columns; ++c) R.start[c + 1] += R.start[c];
  R.column.resize(P.column.size());
  R.weight.resize(P.column.size());
  Array<int> next(R.start.begin(), R.start.end() - 1);
  for (int i = 0; i < P.size(); ++i) {
    if (i % kChunk == 0) progress.report(0);
    for (int e = P.start[i]; e < P.start[i + 1]; ++e) {
      const int place = next[P.column[e]]++;
      R.column[place] = i;
      R.weight[place] = P.weight[e];
    }
  }
  return R;
}

}  // namespace holomorph::solver
