// One V-cycle for K right-hand sides at once, in single precision: the preconditioner.
#pragma once

#include "solver/multigrid_hierarchy.h"

namespace holomorph::solver {

/// The K values at one vertex, side by side: one or two registers.
template <int K>
using Block = Eigen::Array<float, K, 1>;
template <int K>
using Blocks = Array<Block<K>>;
/// Sums over vertices, one per right-hand side.
template <int K>
using Sums = Eigen::Array<double, K, 1>;

/// (A x)_i = sum_j w_ij (x_i - x_j). Inlined, with pointers of its own: to the compiler a block that is written may be
/// one of the vectors' pointers, and would be read again for every entry.
template <int K>
EIGEN_STRONG_INLINE Block<K> difference(const SparseRows& A, int i, const Blocks<K>& x) {
  const int* const column = A.column.data();
  const float* const weight = A.weight.data();
  const Block<K>* const values = x.data();
  const Block<K> here = values[i];
  Block<K> sum = Block<K>::Zero();
  for (int e = A.start[i], end = A.start[i + 1]; e < end; ++e) sum += weight[e] * (here - values[column[e]]);
  return sum;
}

/// omega_i r_i, the smoother's step; 0 at a held vertex for the right-hand sides that hold it.
/// @param natural 1 for the right-hand sides that do not, 0 for the others
template <int K>
EIGEN_STRONG_INLINE Block<K> jacobi_step(const Level& level, int i, const Block<K>& r, const Block<K>& natural) {
  const float omega = level.omega[i];
  if (omega >= 0) return omega * r;
  return (-omega * natural) * r;
}

/// z = M r for the symmetric positive semi-definite M of one V-cycle: a Jacobi step on each level down (on the way down
/// from zero, so that it is one product), the exact solution on the coarsest, a Jacobi step on each level up.
template <int K>
class Cycle {
 public:
  Cycle(const Hierarchy& hierarchy, Workers& workers);

  /// @param natural of jacobi_step(); 1 for all until this is called
  void set_conditions(const Block<K>& natural) { natural_ = natural; }

  /// The residual r that run() is applied to, 0 where vertices are held, and its jacobi_step(); both for the caller to
  /// fill.
  Blocks<K>& residual() { return work_[0].r; }
  Blocks<K>& start() { return work_[0].u; }
  /// z, in the place of start().
  const Blocks<K>& result() const { return work_[0].u; }

  /// @return sum over the vertices of r z
  Sums<K> run();

 private:
  struct Work {
    Blocks<K> r, u, t;
  };
  void descend(std::size_t level);
  void solve_coarsest();
  void carry_up(std::size_t level);

  const Hierarchy& hierarchy_;
  Workers& workers_;
  Block<K> natural_ = Block<K>::Ones();
  std::vector<Work> work_;
};

extern template class Cycle<2>;
extern template class Cycle<4>;
extern template class Cycle<8>;

}  // namespace holomorph::solver
