#include "solver/multigrid_hierarchy.h"

#include <Eigen/Cholesky>

#include "solver/level_operators.h"
#include "solver/weight_rests.h"

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

Eigen::MatrixXd dense(const CycleLevel& level) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(level.rows, level.rows);
  for (int chunk = 0; chunk < level.chunks; ++chunk) {
    level.A.for_rows(chunk, [&A](int i, const Entry* entries, int length) {
      for (int e = 0; e < length; ++e) {
        // half from either side, so that the inverse is symmetric
        const int j = entries[e].column;
        const double half = 0.5 * entries[e].weight;
        A(i, j) -= half;
        A(j, i) -= half;
        A(i, i) += half;
        A(j, j) += half;
      }
    });
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

// One of each per thread.
struct Scratch {
  std::vector<RowSums<float>> means;
  std::vector<RowSums<double>> rows;
};

// Coarsening is done by one thread, the needs of A by the others meanwhile.
Coarsening coarsening_and_needs(Level& level, const Array<float>& largest, Workers& workers) {
  const int chunks = wave_chunks(level.A.size());
  Coarsening result;
  level.needs_of_A.resize(chunks);
  run_throwing(workers, 1 + chunks, [&](int task) {
    if (task == 0) {
      result = coarsening(level.A, largest, level.held);
    } else {
      level.needs_of_A[task - 1] = needs_of(level.A.rows, task - 1, chunks);
    }
  });
  return result;
}

// P, R, the next level's flags and operator; false where the vertices are few enough, or where no step leaves few
// enough.
// @param scratch one per thread, made on the finest level
bool coarsen(Level& level, const Array<float>& largest, int most_means, Scratch& scratch, Level& next,
             Operator& next_operator, Workers& workers, Execution& execution) {
  const int n = level.A.size();
  if (n <= kCoarsest) return false;
  const auto [coarse, count] = coarsening_and_needs(level, largest, workers);
  if (count > kSlowest * n) return false;
  while (static_cast<int>(scratch.means.size()) < workers.count()) {
    scratch.means.emplace_back(count);
    scratch.rows.emplace_back(count);
  }
  level.P = interpolation(level.A, largest, level.held, coarse, most_means, scratch.means, workers, execution);
  level.R = transposed(level.P, count, wave_chunks(n), workers, execution);
  next.held = held_below(level.held, coarse, count);
  next_operator = coarse_operator(level, next.held, scratch.rows, workers, execution);
  return true;
}

}  // namespace

double Hierarchy::operator_complexity() const {
  const auto entries = [](const CycleLevel& level) {
    return static_cast<double>(level.A.entries().size()) + level.rows;
  };
  double sum = 0;
  for (const CycleLevel& level : levels) sum += entries(level);
  return sum / entries(levels[0]);
}

void make_hierarchy(Laplacian&& L, const std::vector<int>& held, Workers& workers, Execution& execution,
                    Hierarchy& hierarchy) {
  Level level;
  const int n = L.size();
  if (!held.empty()) level.held.assign(n, 0);
  for (const int v : held) level.held[v] = 1;
  Operator here = finest_operator(L, level.held, workers, execution);
  hierarchy.rests = weight_rests(L, here.A, workers, execution);
  L = {};
  Scratch scratch;
  for (;;) {
    level.A = std::move(here.A);
    Level next;
    Operator next_operator;
    const int most = hierarchy.levels.empty() ? kFinestMeans : kCoarseMeans;
    const bool last = !coarsen(level, here.largest, most, scratch, next, next_operator, workers, execution);
    hierarchy.levels.push_back(cycle_level(std::move(level.A.rows), std::move(level.P), std::move(level.R.rows),
                                           std::move(here.omega), level.needs_of_A, workers));
    execution.report(0);
    if (last) break;
    level = std::move(next);
    here = std::move(next_operator);
  }
  const int coarsest = hierarchy.levels.back().rows;
  if (coarsest > kLargestDense) {
    throw SolverError("the multigrid hierarchy of a system of " + std::to_string(n) + " unknowns ends at " +
                      std::to_string(coarsest));
  }
  const Eigen::MatrixXd A = dense(hierarchy.levels.back());
  hierarchy.coarsest_inverse = pseudo_inverse(A);
  if (!held.empty()) hierarchy.held_inverse = inverse_of_others(A, level.held);
}

}  // namespace holomorph::solver
