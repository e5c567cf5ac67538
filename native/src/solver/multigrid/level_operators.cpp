#include "solver/multigrid/level_operators.h"

#include <cmath>

#include "solver/multigrid/sparse_accumulator.h"

namespace holomorph::solver {
namespace {

// Jacobi's step is this / sum_j |a_ij| with the diagonal: below 2 the smoother is convergent for weights of any signs.
// The number of iterations is flat around these values.
constexpr double kFinestStep = 1.55, kCoarseStep = 1.9;
// A weight of at most this part of the largest entries at both ends is what is left of others' rounding: a diagonal of
// a rectangle, whose angles are 90 degrees up to the last bit.
constexpr double kRounding = 1e-14;

// Sums over the weights of one row.
struct RowMeasures {
  double diagonal = 0, sum = 0;
  float largest = 0;

  void add(float weight) {
    diagonal += weight;
    sum += std::abs(weight);
    largest = std::max(largest, weight);
  }
};

// Writes what the smoother and coarsening need of row i. @param step kFinestStep or kCoarseStep
void write_measures(const RowMeasures& row, double step, int i, Operator& result) {
  const double bound = row.sum + std::abs(row.diagonal);
  const float omega = bound > 0 ? static_cast<float>(step / bound) : 0.0F;
  result.omega[i] = result.is_fixed(i) ? -omega : omega;
  result.largest[i] = row.largest;
}

Operator empty_operator(std::size_t rows, Array<char> fixed) {
  return {{}, Array<float>(rows), Array<float>(rows), std::move(fixed)};
}

// The largest entry of each row, that of the diagonal included.
Array<float> row_sizes(const Laplacian& L, Workers& workers) {
  Array<float> sizes(L.size());
  for_rows(workers, L.size(), [&](int i) {
    double most = 0;
    for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) most = std::max(most, std::abs(L.weights[e]));
    sizes[i] = static_cast<float>(most);
  });
  return sizes;
}

// Adds row I of P^T A P; its diagonal is not the sum of A's, which is not stored.
template <int Most>
void add_row(const SparseRows& A, const EqualRows& P, const SparseRows& R, int I, SparseAccumulator<double>& sums) {
  const auto add = [&](int i, double weight) {
    const Entry* const row = P.entries.data() + std::size_t{Most} * i;
    for (int k = 0; k < Most; ++k) sums.add(row[k].column, weight * row[k].weight);
  };
  for (const auto [i, part] : R[I]) {
    sums.reserve(Most * (A[i].size() + 1));
    double diagonal = 0;
    for (const Entry& entry : A[i]) {
      const double weight = static_cast<double>(part) * entry.weight;
      diagonal += weight;
      add(entry.column, weight);
    }
    add(i, -diagonal);
  }
}

Array<char> fixed_C_points(const Array<char>& fixed, const Coarsening& coarse) {
  if (fixed.empty()) return {};
  Array<char> result(coarse.count);
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (coarse.number[i] >= 0) result[coarse.number[i]] = fixed[i];
  }
  return result;
}

}  // namespace

Operator finest_operator(const Laplacian& L, Array<char> fixed, Execution& execution) {
  const Array<float> sizes = row_sizes(L, execution.workers());
  Operator result = empty_operator(L.size(), std::move(fixed));
  result.A = build_rows(L.size(), execution, [&](int, int i, std::vector<Entry>& part) {
    RowMeasures measures;
    for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) {
      const int j = L.columns[e];
      const auto weight = -static_cast<float>(L.weights[e]);
      if (j == i || weight == 0 || std::abs(L.weights[e]) <= kRounding * std::min(sizes[i], sizes[j])) continue;
      part.push_back({j, weight});
      measures.add(weight);
    }
    write_measures(measures, kFinestStep, i, result);
  });
  return result;
}

Operator coarse_operator(const Operator& fine, const Coarsening& coarse, const EqualRows& P, const SparseRows& R,
                         Execution& execution) {
  std::vector<SparseAccumulator<double>> accumulators(execution.threads(), SparseAccumulator<double>(coarse.count));
  Operator result = empty_operator(coarse.count, fixed_C_points(fine.fixed, coarse));
  result.A = build_rows(coarse.count, execution, [&](int thread, int I, std::vector<Entry>& part) {
    SparseAccumulator<double>& sums = accumulators[thread];
    if (P.each == 2) {
      add_row<2>(fine.A, P, R, I, sums);
    } else {
      add_row<3>(fine.A, P, R, I, sums);
    }
    RowMeasures measures;
    sums.take([&](int J, double sum) {
      const auto weight = static_cast<float>(sum);
      // The diagonal is not stored: rows sum to 0 (coarsening.h).
      if (J == I || weight == 0) return;
      part.push_back({J, weight});
      measures.add(weight);
    });
    write_measures(measures, kCoarseStep, I, result);
  });
  return result;
}

}  // namespace holomorph::solver
