// One V-cycle for K right-hand sides at once, in single precision: the preconditioner.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/page_allocator.h"
#include "solver/multigrid/coarsening.h"
#include "solver/multigrid/hierarchy.h"

namespace holomorph::solver {

// K values at every vertex, and the loops over rows that apply a level's matrices to them.

/// The K values at one vertex, side by side: one or two registers.
template <int K>
using Block = Eigen::Array<float, K, 1>;
template <int K>
using Blocks = Array<Block<K>>;
/// Sums over vertices, one per right-hand side.
template <int K>
using Sums = Eigen::Array<double, K, 1>;

/// Prefetch distance, in entries, 4 KB: the processor does not look beyond a page by itself.
inline constexpr int kAhead = 512;

/// A range of rows, such as a chunk.
struct Rows {
  int begin, end;
};

inline Rows rows_of_chunk(int chunk, int rows, int each = kChunkRows) {
  return {std::min(chunk * each, rows), std::min((chunk + 1) * each, rows)};
}

/// Calls loop(chunk, rows) for all chunks with this number of rows, in parallel. @pre loop does not throw
template <class Loop>
void for_chunks(int rows, Workers& workers, const Loop& loop) {
  workers.run(row_chunks(rows), [&](int, int chunk) { loop(chunk, rows_of_chunk(chunk, rows)); });
}

// Bodies of the loops below capture pointers by value. Otherwise the compiler reads them again for every row: for all
// it knows, the block that a body writes is one of them.

/// body(i, (A x)_i) for the rows of a chunk, with (A x)_i = sum_j w_ij (x_i - x_j).
template <int K, class Body>
EIGEN_STRONG_INLINE void for_differences(const SparseRows& A, Rows rows, const Block<K>* x, const Body& body) {
  const int *const starts = A.starts.data(), *const ends = A.ends.data(), *const order = A.order.data();
  const Entry* const entries = A.entries.data();
  for (int k = rows.begin; k < rows.end; ++k) {
    const int i = order[k];
    prefetch(entries + starts[i] + kAhead);
    const Block<K> here = x[i];
    Block<K> sum = Block<K>::Zero();
    for (int e = starts[i], end = ends[i]; e < end; ++e) sum += entries[e].weight * (here - x[entries[e].column]);
    body(i, sum);
  }
}

/// body(i, (R x)_i) for a range of rows.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const SparseRows& R, Rows rows, const Block<K>* x, const Body& body) {
  const int *const starts = R.starts.data(), *const ends = R.ends.data();
  const Entry* const entries = R.entries.data();
  for (int i = rows.begin; i < rows.end; ++i) {
    Block<K> sum = Block<K>::Zero();
    for (int e = starts[i], end = ends[i]; e < end; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  }
}

/// body(i, (P x)_i) for a range of rows.
template <int K, class Body>
EIGEN_STRONG_INLINE void for_products(const EqualRows& P, Rows rows, const Block<K>* x, const Body& body) {
  const int each = P.each;
  const Entry* entries = P[rows.begin];
  for (int i = rows.begin; i < rows.end; ++i, entries += each) {
    Block<K> sum = entries[0].weight * x[entries[0].column];
    for (int e = 1; e < each; ++e) sum += entries[e].weight * x[entries[e].column];
    body(i, sum);
  }
}

/// omega r, the smoother's step; 0 at a fixed vertex for the right-hand sides with the Dirichlet condition.
/// @param natural 1 for the right-hand sides with the natural condition, 0 for the others
template <int K>
EIGEN_STRONG_INLINE Block<K> jacobi_step(float omega, const Block<K>& r, const Block<K>& natural) {
  if (omega >= 0) return omega * r;
  return (-omega * natural) * r;
}

/// Returns the residual r that gave a jacobi_step(), where the vertex is not fixed.
template <int K>
EIGEN_STRONG_INLINE Block<K> residual_of_step(float omega, const Block<K>& step) {
  const float size = std::abs(omega);
  return (size > 0 ? 1 / size : 0.0F) * step;
}

/// z = M r for the symmetric positive semi-definite M of one V-cycle. Each level has a Jacobi step before and after the
/// coarse-grid correction; the coarsest is solved exactly. Below one coarse level the cycle runs a second time, for the
/// residual that the first leaves. A residual r is given only as s = omega r, its jacobi_step(), with which the cycle
/// begins. This saves writing and reading a vector.
template <int K>
class Cycle {
 public:
  Cycle(const Hierarchy& hierarchy, Workers& workers);

  /// @param natural of jacobi_step(); 1 for all until this is called
  void set_conditions(const Block<K>& natural) { natural_ = natural; }

  /// jacobi_step() of the residual r, #V: to be filled before run().
  Block<K>* step() { return work_[0].s.data(); }
  /// z, #V, after run().
  const Block<K>* result() const { return work_[0].u.data(); }
  /// #V values between one run() and the next, which overwrites them.
  Block<K>* scratch() { return work_[0].t.data(); }

  /// Computes z from step(), and calls last(chunk, rows) for all chunks of the rows. It may read z at the neighbours of
  /// these rows and write scratch() at these rows.
  template <class Last>
  void run(const Last& last) {
    for (std::size_t k = 0; k < twice_; ++k) restrict_residual(k);
    correct_twice();
    for (std::size_t k = twice_; k-- > 1;) prolongate_and_smooth(k, [](int, Rows) {});
    if (twice_ > 0) {
      prolongate_and_smooth(0, last);
    } else {
      for_chunks(hierarchy_.levels[0].rows(), workers_, last);
    }
  }

 private:
  struct Workspace {
    Blocks<K> s, u, t;  // the residual's step, the correction, intermediate values
  };

  // Computes step() of level k + 1 from that of level k.
  void restrict_residual(std::size_t k);
  // Computes result() of level k from that of level k + 1, and calls last(chunk, rows) as run() does.
  template <class Last>
  void prolongate_and_smooth(std::size_t k, const Last& last) {
    const int rows = hierarchy_.levels[k].rows();
    hierarchy_.levels[k].up.run(
        workers_, [=, this](int chunk) { prolongate(k, rows_of_chunk(chunk, rows)); },
        [=, this](int chunk) { smooth(k, rows_of_chunk(chunk, rows)); },
        [=, &last](int chunk) { last(chunk, rows_of_chunk(chunk, rows)); });
  }
  void prolongate(std::size_t k, Rows rows);
  void smooth(std::size_t k, Rows rows);
  void correct(std::size_t k);
  void correct_twice();
  void solve_coarsest();

  const Hierarchy& hierarchy_;
  Workers& workers_;
  Block<K> natural_ = Block<K>::Ones();
  std::vector<Workspace> work_;  // one for each level
  std::size_t twice_ = 0;        // the level that is corrected twice, or the coarsest one
  Blocks<K> first_;              // correction of that level
};

extern template class Cycle<2>;
extern template class Cycle<4>;
extern template class Cycle<8>;

}  // namespace holomorph::solver
