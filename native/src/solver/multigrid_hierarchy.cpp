#include "solver/multigrid_hierarchy.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "solver/interpolation.h"

namespace holomorph::solver {
namespace {

// Here coarsening ends, and a dense inverse is applied: about 30 us.
constexpr int kCoarsest = 250;
// A step that leaves more than this part of the vertices has met a graph without strong edges.
constexpr double kSlowest = 0.9;
// Up to here a dense inverse is still possible where coarsening ended early.
constexpr int kLargestDense = 2000;
// Entries of a row of P, finest level and below: the fewest that keep the number of iterations.
constexpr int kFinestMeans = 2, kCoarseMeans = 3;
// Jacobi's step is kStep / sum_j |a_ij| with the diagonal: below 2 the smoother is convergent for weights of any signs.
constexpr double kStep = 1.6;

SparseRows finest_weights(const Laplacian& L, Workers& workers) {
  const int n = static_cast<int>(L.rows());
  const auto kept = [&](Laplacian::StorageIndex e, int i) {
    return L.innerIndexPtr()[e] != i && static_cast<float>(L.valuePtr()[e]) != 0;
  };
  SparseRows A;
  A.start.assign(n + std::size_t{1}, 0);
  for_rows(workers, n, [&](int i) {
    for (auto e = L.outerIndexPtr()[i]; e < L.outerIndexPtr()[i + 1]; ++e) A.start[i + 1] += kept(e, i);
  });
  for (int i = 0; i < n; ++i) A.start[i + 1] += A.start[i];
  A.column.resize(A.start[n]);
  A.weight.resize(A.start[n]);
  for_rows(workers, n, [&](int i) {
    int place = A.start[i];
    for (auto e = L.outerIndexPtr()[i]; e < L.outerIndexPtr()[i + 1]; ++e) {
      if (!kept(e, i)) continue;
      A.column[place] = L.innerIndexPtr()[e];
      A.weight[place++] = -static_cast<float>(L.valuePtr()[e]);
    }
  });
  return A;
}

Array<float> jacobi_steps(const SparseRows& A, const Array<char>& held, Workers& workers) {
  Array<float> omega(A.size());
  for_rows(workers, A.size(), [&](int i) {
    double diagonal = 0, sum = 0;
    for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
      diagonal += A.weight[e];
      sum += std::abs(A.weight[e]);
    }
    sum += std::abs(diagonal);
    omega[i] = sum > 0 ? static_cast<float>(kStep / sum) : 0.0F;
    if (!held.empty() && held[i] != 0) omega[i] = -omega[i];
  });
  return omega;
}

// Sums of one row of the coarse operator by column; an entry belongs to the row whose number it bears.
struct RowSums {
  struct Entry {
    int row = -1;
    double value = 0;
  };
  std::vector<Entry> entries;
  std::vector<int> columns;

  void add(int row, int column, double value) {
    Entry& entry = entries[column];
    if (entry.row != row) {
      entry = {row, value};
      columns.push_back(column);
    } else {
      entry.value += value;
    }
  }
};

// Off-diagonal weights of P^T A P, summed in double precision; the diagonal follows from them, as rows sum to 0.
SparseRows coarse_operator(const Level& fine, Workers& workers, Progress& progress) {
  const SparseRows &A = fine.A, &P = fine.P, &R = fine.R;
  const int n = R.size();
  const auto scratch = [&] { return RowSums{std::vector<RowSums::Entry>(n), {}}; };
  const auto expected = 2 * A.column.size() / 3;
  return build_rows(n, expected, workers, progress, scratch, [&](RowSums& sums, int I, auto& part) {
    sums.columns.clear();
    for (int r = R.start[I]; r < R.start[I + 1]; ++r) {
      const int i = R.column[r];
      double diagonal = 0;
      for (int e = A.start[i]; e < A.start[i + 1]; ++e) {
        const int j = A.column[e];
        const double weight = static_cast<double>(R.weight[r]) * A.weight[e];
        diagonal += weight;
        for (int p = P.start[j]; p < P.start[j + 1]; ++p) sums.add(I, P.column[p], weight * P.weight[p]);
      }
      for (int p = P.start[i]; p < P.start[i + 1]; ++p) sums.add(I, P.column[p], -diagonal * P.weight[p]);
    }
    std::sort(sums.columns.begin(), sums.columns.end());
    for (const int J : sums.columns) {
      const auto weight = static_cast<float>(sums.entries[J].value);
      if (J == I || weight == 0) continue;
      part.column.push_back(J);
      part.weight.push_back(weight);
    }
  });
}

Eigen::MatrixXd dense(const SparseRows& weights) {
  const int n = weights.size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int e = weights.start[i]; e < weights.start[i + 1]; ++e) {
      // half from either side, so that the inverse is symmetric
      const int j = weights.column[e];
      const double half = 0.5 * weights.weight[e];
      A(i, j) -= half;
      A(j, i) -= half;
      A(i, i) += half;
      A(j, j) += half;
    }
  }
  return A;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) {
    throw SolverError("the multigrid hierarchy failed: its coarsest matrix, of " + std::to_string(A.rows()) +
                      " unknowns, is not positive semi-definite");
  }
  return factor.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
}

// With the constants, the kernel, lifted to an eigenvalue like the others and taken out again.
Eigen::MatrixXf pseudo_inverse(Eigen::MatrixXd A) {
  const auto n = static_cast<double>(A.rows());
  const double trace = A.trace();
  const double lift = trace > 0 ? trace / n / n : 1.0;
  A.array() += lift;
  return (inverse(A).array() - 1.0 / (lift * n * n)).cast<float>();
}

Eigen::MatrixXf inverse_of_others(const Eigen::MatrixXd& A, const Array<char>& held) {
  std::vector<int> others;
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    if (held[i] == 0) others.push_back(i);
  }
  Eigen::MatrixXf result = Eigen::MatrixXf::Zero(A.rows(), A.cols());
  if (!others.empty()) result(others, others) = inverse(A(others, others)).cast<float>();
  return result;
}

// The flags of the next level.
Array<char> held_below(const Array<char>& held, const Array<int>& coarse, int coarse_count) {
  if (held.empty()) return {};
  Array<char> below(coarse_count);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (coarse[i] >= 0) below[coarse[i]] = held[i];
  }
  return below;
}

}  // namespace

double Hierarchy::operator_complexity() const {
  double entries = 0;
  for (const Level& level : levels) entries += static_cast<double>(level.A.column.size() + level.A.size());
  return entries / static_cast<double>(levels[0].A.column.size() + levels[0].A.size());
}

Hierarchy make_hierarchy(const Laplacian& L, const std::vector<int>& held, Workers& workers, Progress& progress) {
  Hierarchy result;
  result.levels.emplace_back();
  result.levels[0].A = finest_weights(L, workers);
  if (!held.empty()) result.levels[0].held.assign(L.rows(), 0);
  for (const int v : held) result.levels[0].held[v] = 1;
  progress.report(0);
  for (;;) {
    Level& level = result.levels.back();
    level.omega = jacobi_steps(level.A, level.held, workers);
    progress.report(0);
    const int n = level.A.size();
    if (n <= kCoarsest) break;
    const Array<int> coarse = coarse_vertices(level.A, level.held, workers, progress);
    const int count = 1 + *std::max_element(coarse.begin(), coarse.end());
    if (count > kSlowest * n) break;
    const int most = result.levels.size() == 1 ? kFinestMeans : kCoarseMeans;
    level.P = interpolation(level.A, level.held, coarse, count, most, workers, progress);
    level.R = transposed(level.P, count, progress);
    Level next;
    next.A = coarse_operator(level, workers, progress);
    next.held = held_below(level.held, coarse, count);
    result.levels.push_back(std::move(next));
  }
  const int coarsest = result.levels.back().A.size();
  if (coarsest > kLargestDense) {
    throw SolverError("the multigrid hierarchy of a system of " + std::to_string(L.rows()) + " unknowns ends at " +
                      std::to_string(coarsest));
  }
  progress.report(0);
  const Eigen::MatrixXd A = dense(result.levels.back().A);
  result.coarsest_inverse = pseudo_inverse(A);
  if (!held.empty()) result.held_inverse = inverse_of_others(A, result.levels.back().held);
  return result;
}

}  // namespace holomorph::solver
