#include "solver/multigrid/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/dense.h"
#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {
namespace {

constexpr int kLeft = std::numeric_limits<int>::max();
// The fewest chunks in a segment: with fewer, too many chunks need another segment.
constexpr int kShortestSegment = 32;
// Segments for each thread: more than one, so that others can take work from a thread that comes late.
constexpr int kSegmentsPerThread = 2;

// After which chunk of the first loop a chunk may be done, given those times for the loop before; kLeft if it needs
// chunks that are not in the segment `begin` .. `end` - 1.
int ready(int chunk, const std::vector<int>& needs, const std::vector<int>& before, int begin, int end) {
  int time = before[chunk];
  for (const int c : needs) time = c < begin || c >= end ? kLeft : std::max(time, before[c]);
  return time;
}

Eigen::MatrixXd dense(const SparseRows& A) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(A.size(), A.size());
  for (int i = 0; i < A.size(); ++i) {
    for (const auto [j, weight] : A[i]) {
      const double half = 0.5 * weight;  // from either side, so that the inverse is symmetric
      result(i, j) -= half;
      result(j, i) -= half;
      result(i, i) += half;
      result(j, j) += half;
    }
  }
  return result;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
  const linear::Cholesky factor(A);
  if (!factor.succeeded()) {
    throw SolverError("the multigrid hierarchy failed: its coarsest matrix, of " + std::to_string(A.rows()) +
                      " unknowns, is not positive semi-definite");
  }
  return factor.inverse();
}

// Adds a multiple of the matrix of ones, which gives the constants, the kernel of A, the mean of all eigenvalues. The
// inverse has that part subtracted again.
Eigen::MatrixXf pseudo_inverse(Eigen::MatrixXd A) {
  const auto n = static_cast<double>(A.rows());
  const double trace = A.trace();
  const double lift = trace > 0 ? trace / n / n : 1.0;
  A.array() += lift;
  return (inverse(A).array() - 1.0 / (lift * n * n)).cast<float>();
}

Eigen::MatrixXf inverse_without_fixed(const Eigen::MatrixXd& A, const Array<char>& fixed) {
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(fixed.size()); ++i) {
    if (fixed[i] == 0) free.push_back(i);
  }
  Eigen::MatrixXf result = Eigen::MatrixXf::Zero(A.rows(), A.cols());
  if (!free.empty()) result(free, free) = inverse(A(free, free)).cast<float>();
  return result;
}

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

// Coarsening ends at this size, where applying a dense inverse takes about 30 us.
constexpr int kCoarsest = 250;
// Coarsening also ends if a step leaves more than this part of the vertices: such a graph has no strong edges.
constexpr double kSlowest = 0.9;
// The largest dense inverse, where coarsening ended early.
constexpr int kLargestDense = 2000;
// Entries of a row of P, finest level and below: the fewest that keep the number of iterations.
constexpr double kOperations = 500;  // for each unknown
constexpr int kFinestEntries = 2, kCoarseEntries = 3;

Array<char> fixed_flags(int n, const std::vector<int>& fixed) {
  if (fixed.empty()) return {};
  Array<char> flags(n);
  std::fill(flags.begin(), flags.end(), 0);
  for (const int v : fixed) flags[v] = 1;
  return flags;
}

// Lists the chunks of kChunkRows in which the rows of M have columns, for `chunks` chunks of `each` rows.
ChunkNeeds chunk_needs(const SparseRows& M, int each, int chunks, Workers& workers) {
  ChunkNeeds needs(chunks);
  run_throwing(workers, chunks, [&](int chunk) {
    const int begin = std::min(chunk * each, M.size()), end = std::min(begin + each, M.size());
    std::vector<char> found(chunks, 0);
    for (int i = begin; i < end; ++i) {
      for (const Entry& entry : M[i]) {
        const int need = entry.column / kChunkRows;
        if (found[need] == 0) needs[chunk].push_back(need);
        found[need] = 1;
      }
    }
  });
  return needs;
}

// Adds the inverse relation: where d needs c, c needs d, too.
ChunkNeeds symmetrised(const ChunkNeeds& needs) {
  ChunkNeeds result = needs;
  for (int chunk = 0; chunk < static_cast<int>(needs.size()); ++chunk) {
    for (const int c : needs[chunk]) {
      const bool known = std::find(needs[c].begin(), needs[c].end(), chunk) != needs[c].end();
      if (!known) result[c].push_back(chunk);
    }
  }
  return result;
}

// The order of the loops over a level. The last of those up may write what the one before reads, so that it needs both
// directions: of two entries w_ij and w_ji of a matrix symmetric up to rounding one may be 0.
void order_loops(Level& level, Workers& workers) {
  const int chunks = row_chunks(level.rows());
  const ChunkNeeds needs_A = chunk_needs(level.op.A, kChunkRows, chunks, workers);
  const ChunkNeeds needs_R = chunk_needs(level.R, coarse_rows_per_chunk(level), chunks, workers);
  level.down = Wavefront(chunks, {needs_R}, workers.count());
  level.up = Wavefront(chunks, {needs_A, symmetrised(needs_A)}, workers.count());
}

// Both symmetric, computed in double precision. Cost: cubic in the size of A, which is a few hundred.
// @throws SolverError if A is not positive semi-definite
CoarsestInverse coarsest_inverse(const Operator& coarsest) {
  const Eigen::MatrixXd A = dense(coarsest.A);
  CoarsestInverse result{pseudo_inverse(A), {}};
  if (!coarsest.fixed.empty()) result.dirichlet = inverse_without_fixed(A, coarsest.fixed);
  return result;
}

// Takes over the weights of L, without those that are only rounding.
// @param fixed one flag per vertex, or empty for none
// @throws std::bad_alloc, Cancelled
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

// Computes P^T A P, summed in double precision. It is kept as differences, since its rows sum to 0. A coarse vertex is
// fixed where its C-point is.
// @param P interpolation() @param R its transpose
// @throws std::bad_alloc, Cancelled
// Cost: linear, in parallel.
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

}  // namespace

Wavefront::Wavefront(int chunks, const std::vector<ChunkNeeds>& needs, int threads)
    : segments_(threads * std::min(kSegmentsPerThread, chunks / (kShortestSegment * threads))),
      left_(needs.size() + 1) {
  std::vector<std::vector<int>> time(left_.size(), std::vector<int>(chunks, kLeft));
  const auto count = static_cast<std::int64_t>(segments_.size());
  for (std::int64_t s = 0; s < count; ++s) {
    const int begin = static_cast<int>(chunks * s / count), end = static_cast<int>(chunks * (s + 1) / count);
    std::vector<std::vector<Step>> at(end - begin);
    for (int loop = 0; loop < static_cast<int>(time.size()); ++loop) {
      for (int c = begin; c < end; ++c) {
        // A chunk of a later loop follows, in its segment, as soon as the last chunk that it needs is done.
        time[loop][c] = loop == 0 ? c : ready(c, needs[loop - 1][c], time[loop - 1], begin, end);
        if (time[loop][c] != kLeft) at[time[loop][c] - begin].push_back({loop, c});
      }
    }
    for (const auto& steps : at) segments_[s].insert(segments_[s].end(), steps.begin(), steps.end());
  }
  for (std::size_t loop = 0; loop < time.size(); ++loop) {
    for (int c = 0; c < chunks; ++c) {
      if (time[loop][c] == kLeft) left_[loop].push_back(c);
    }
  }
}

Hierarchy make_hierarchy(const Laplacian& L, const std::vector<int>& fixed, Execution& execution) {
  Execution::count(kOperations * L.size());
  Hierarchy result;
  std::vector<Level>& levels = result.levels;
  levels.push_back({finest_operator(L, fixed_flags(L.size(), fixed), execution), {}, {}, {}, {}});
  while (levels.back().rows() > kCoarsest) {
    Level& fine = levels.back();
    const Coarsening coarse = coarsening(fine.op);
    if (coarse.count > kSlowest * fine.rows()) break;
    fine.P = interpolation(fine.op, coarse, levels.size() == 1 ? kFinestEntries : kCoarseEntries, execution);
    fine.R = transposed(fine.P, coarse.count);
    Operator next = coarse_operator(fine.op, coarse, fine.P, fine.R, execution);
    // Only coarsening and interpolation need it.
    fine.op.largest = {};
    order_loops(fine, execution.workers());
    levels.push_back({std::move(next), {}, {}, {}, {}});
  }
  if (levels.back().rows() > kLargestDense) {
    throw SolverError("the multigrid hierarchy of a system of " + std::to_string(L.size()) + " unknowns ends at " +
                      std::to_string(levels.back().rows()));
  }
  result.coarsest = coarsest_inverse(levels.back().op);
  return result;
}

}  // namespace holomorph::solver
