// One V-cycle for K right-hand sides at once, in single precision: the preconditioner.
#pragma once

#include "solver/multigrid/block_loops.h"
#include "solver/multigrid/hierarchy.h"

namespace holomorph::solver {

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
