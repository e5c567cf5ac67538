#include "solver/level_operators.h"

#include <cmath>

#include "solver/row_parts.h"

namespace holomorph::solver {
namespace {

// Jacobi's step is this / sum_j |a_ij| with the diagonal: below 2 the smoother is convergent for weights of any signs.
// On nine meshes, irregular, stretched and bad, 1.5 to 1.6 and 1.8 to 1.9 do about equally well; both 1.6 takes half an
// iteration of sixteen more, both 1.75 up to five more where a mesh is stretched, and 1.95 below two on a brain.
constexpr double kFinestStep = 1.55, kCoarseStep = 1.9;
// A weight of at most this part of the largest entries at both ends is what is left of others' rounding: a diagonal of
// a rectangle, whose angles are 90 degrees up to the last bit.
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
  /// kFinestStep or kCoarseStep of it.
  float jacobi_step(double part) const {
    const double bound = sum + std::abs(diagonal);
    return bound > 0 ? static_cast<float>(part / bound) : 0.0F;
  }
};

// Writes the measures of row i, given the part of jacobi_step(); a held vertex has the opposite step.
void note(const RowMeasures& row, double part, int i, const Array<char>& held, Operator& result) {
  const float step = row.jacobi_step(part);
  result.omega[i] = !held.empty() && held[i] != 0 ? -step : step;
  result.largest[i] = row.largest;
}

// The largest entry of each row, that of the diagonal included.
Array<float> row_sizes(const Laplacian& L, Workers& workers, Execution& execution) {
  const int n = L.size();
  const double* const value = L.weights.data();
  Array<float> sizes(n);
  for_set_up_chunks(workers, n, execution, [&](int, int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      double most = 0;
      for (int e = L.starts[i]; e < L.starts[i + 1]; ++e) most = std::max(most, std::abs(value[e]));
      sizes[i] = static_cast<float>(most);
    }
  });
  return sizes;
}

// Row I of P^T A P without its diagonal, which follows as rows sum to 0.
template <int Most>
void sum_up_row(const Level& fine, int I, RowSums<double>& room, RowSums<double>::Row& sums) {
  const Entry* const means = fine.P.entry.data();
  const auto add = [&](int i, double weight) {
    const Entry* const mean = means + std::size_t{Most} * i;
    for (int k = 0; k < Most; ++k) sums.add(mean[k].column, weight * mean[k].weight);
  };
  for (const auto [i, part] : fine.R[I]) {
    const auto row = fine.A[i];
    room.make_room(sums, Most * (static_cast<int>(row.size()) + 1));
    double diagonal = 0;
    for (const Entry& entry : row) {
      const double weight = static_cast<double>(part) * entry.weight;
      diagonal += weight;
      add(entry.column, weight);
    }
    add(i, -diagonal);
  }
}

}  // namespace

Operator finest_operator(const Laplacian& L, const Array<char>& held, Workers& workers, Execution& execution) {
  const int n = L.size();
  const int *const start = L.starts.data(), *const column = L.columns.data();
  const double* const value = L.weights.data();
  const Array<float> sizes = row_sizes(L, workers, execution);
  Operator result;
  result.omega.resize(n);
  result.largest.resize(n);
  const std::size_t expected = L.columns.size() - n;  // each row has a diagonal
  result.A = build_rows(n, expected, workers, execution, [&](int, int i, RowPart& part) {
    part.make_room(start[i + 1] - start[i]);
    RowMeasures measures;
    for (auto e = start[i]; e < start[i + 1]; ++e) {
      const int j = column[e];
      const auto weight = -static_cast<float>(value[e]);
      const bool kept = (j != i) & (std::abs(value[e]) > kRounding * std::min(sizes[i], sizes[j])) & (weight != 0);
      part.append(j, weight, kept);
      measures.add(kept ? weight : 0.0F);
    }
    note(measures, kFinestStep, i, held, result);
  });
  return result;
}

Operator coarse_operator(const Level& fine, const Array<char>& held, std::vector<RowSums<double>>& scratch,
                         Workers& workers, Execution& execution) {
  const int n = fine.R.size();
  Operator result;
  result.omega.resize(n);
  result.largest.resize(n);
  const auto expected = fine.A.rows.entries().size();
  result.A = build_rows(n, expected, workers, execution, [&](int thread, int I, RowPart& part) {
    RowSums<double>& room = scratch[thread];
    RowSums<double>::Row sums = room.next();
    if (fine.P.each == 2) {
      sum_up_row<2>(fine, I, room, sums);
    } else {
      sum_up_row<3>(fine, I, room, sums);
    }
    part.make_room(sums.size());
    RowMeasures measures;
    for (int k = 0; k < sums.size(); ++k) {
      const int J = sums.column(k);
      const auto weight = static_cast<float>(sums.take(k));
      const bool kept = (J != I) & (weight != 0);
      part.append(J, weight, kept);
      measures.add(kept ? weight : 0.0F);
    }
    note(measures, kCoarseStep, I, held, result);
  });
  return result;
}

}  // namespace holomorph::solver
