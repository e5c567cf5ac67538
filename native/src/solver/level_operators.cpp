#include "solver/level_operators.h"

#include <cmath>

#include "solver/row_parts.h"

namespace holomorph::solver {
namespace {

// Jacobi's step is kStep / sum_j |a_ij| with the diagonal: below 2 the smoother is convergent for weights of any signs.
constexpr double kStep = 1.6;
// A weight of at most this part of the largest at either end is what is left of others' rounding: a diagonal of a
// rectangle, whose angles are 90 degrees up to the last bit.
constexpr double kRounding = 1e-14;

// Of one row.
struct RowMeasures {
  double diagonal = 0, sum = 0;
  float largest = 0;

  void add(float weight) {
    diagonal += weight;
    sum += std::abs(weight);
    largest = std::max(largest, weight);
  }
  float jacobi_step() const {
    const double bound = sum + std::abs(diagonal);
    return bound > 0 ? static_cast<float>(kStep / bound) : 0.0F;
  }
};

// Writes the measures of row i; a held vertex has the opposite step.
void note(const RowMeasures& row, int i, const Array<char>& held, Operator& result) {
  const float step = row.jacobi_step();
  result.omega[i] = !held.empty() && held[i] != 0 ? -step : step;
  result.largest[i] = row.largest;
}

// The size of a row is that of its largest weight, of either sign.
Array<float> row_sizes(const Laplacian& L, Workers& workers, Progress& progress) {
  Array<float> sizes(L.rows());
  for_set_up_chunks(workers, static_cast<int>(L.rows()), progress, [&](int, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      double most = 0;
      for (auto e = L.outerIndexPtr()[i]; e < L.outerIndexPtr()[i + 1]; ++e) {
        most = std::max(most, L.innerIndexPtr()[e] != i ? std::abs(L.valuePtr()[e]) : 0.0);
      }
      sizes[i] = static_cast<float>(most);
    }
  });
  return sizes;
}

// Row I of P^T A P without its diagonal, which follows as rows sum to 0.
template <int Most>
void sum_up_row(const Level& fine, const Array<Mean>& P, int I, RowSums::Row& sums) {
  const SparseRows &A = fine.A, &R = fine.R;
  const auto add = [&](const Mean& mean, double weight) {
    for (int k = 0; k < Most; ++k) sums.add(mean.vertex[k], weight * mean.weight[k]);
  };
  for (int r = R.start[I]; r < R.start[I + 1]; ++r) {
    const int i = R.column[r];
    const double part = R.weight[r];
    double diagonal = 0;
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      const double weight = part * A.weight[e];
      diagonal += weight;
      add(P[A.column[e]], weight);
    }
    add(P[i], -diagonal);
  }
}

}  // namespace

Operator finest_operator(const Laplacian& L, const Array<char>& held, Workers& workers, Progress& progress) {
  const int n = static_cast<int>(L.rows());
  const auto* const start = L.outerIndexPtr();
  const auto* const column = L.innerIndexPtr();
  const double* const value = L.valuePtr();
  const Array<float> sizes = row_sizes(L, workers, progress);
  const auto kept = [&](int i, Laplacian::StorageIndex e) {
    const int j = column[e];
    return j != i && std::abs(value[e]) > kRounding * std::min(sizes[i], sizes[j]) && static_cast<float>(value[e]) != 0;
  };
  std::vector<int> place(set_up_chunks(n) + 1, 0);
  for_set_up_chunks(workers, n, progress, [&](int, int chunk, int begin, int end) {
    int entries = 0;
    for (int i = begin; i < end; ++i) {
      for (auto e = start[i]; e < start[i + 1]; ++e) entries += kept(i, e);
    }
    place[chunk + 1] = entries;
  });
  for (std::size_t c = 1; c < place.size(); ++c) place[c] += place[c - 1];
  Operator result;
  result.A.start.resize(n + std::size_t{1});
  result.A.start[0] = 0;
  result.A.column.resize(place.back());
  result.A.weight.resize(place.back());
  result.omega.resize(n);
  result.largest.resize(n);
  for_set_up_chunks(workers, n, progress, [&](int, int chunk, int begin, int end) {
    int next = place[chunk];
    for (int i = begin; i < end; ++i) {
      RowMeasures measures;
      for (auto e = start[i]; e < start[i + 1]; ++e) {
        if (!kept(i, e)) continue;
        const auto weight = -static_cast<float>(value[e]);
        result.A.column[next] = column[e];
        result.A.weight[next++] = weight;
        measures.add(weight);
      }
      result.A.start[i + 1] = next;
      note(measures, i, held, result);
    }
  });
  return result;
}

Operator coarse_operator(const Level& fine, const Array<Mean>& P, int most, const Array<char>& held,
                         std::vector<RowSums>& scratch, Workers& workers, Progress& progress) {
  const int n = fine.R.size();
  Operator result;
  result.omega.resize(n);
  result.largest.resize(n);
  const auto expected = fine.A.column.size();
  result.A = build_rows(n, expected, workers, progress, [&](int thread, int I, RowPart& part) {
    RowSums::Row sums = scratch[thread].next();
    if (most == 2) {
      sum_up_row<2>(fine, P, I, sums);
    } else {
      sum_up_row<kMostMeans>(fine, P, I, sums);
    }
    part.make_room(sums.size());
    RowMeasures measures;
    for (int k = 0; k < sums.size(); ++k) {
      const auto weight = static_cast<float>(sums.sum(k));
      const bool kept = sums.column(k) != I && weight != 0;
      part.append(sums.column(k), weight, kept);
      if (kept) measures.add(weight);
    }
    note(measures, I, held, result);
  });
  return result;
}

}  // namespace holomorph::solver
