// One V-cycle for K right-hand sides at once, in single precision: the preconditioner.
#pragma once

#include "base/workers.h"
#include "solver/block_loops.h"
#include "solver/multigrid_hierarchy.h"

namespace holomorph::solver {

/// z = M r for the symmetric positive semi-definite M of one V-cycle: a Jacobi step on each level down (on the way down
/// from zero, so that it is one product), the exact solution on the coarsest, a Jacobi step on each level up; below one
/// coarse level a second time, for the residual that the first leaves. On each level the loops down, and those up, are
/// one wavefront each, which the caller's loops on the finest level join. A residual r is known by its jacobi_step()
/// s = omega r alone, with which the way down begins: a vector less to write and to read than with both.
template <int K>
class Cycle {
 public:
  Cycle(const Hierarchy& hierarchy, Workers& workers);

  /// @param natural of jacobi_step(); 1 for all until this is called
  void set_conditions(const Block<K>& natural) { natural_ = natural; }

  /// jacobi_step() of the residual: for the first loop to fill.
  Block<K>* start() { return work_[0].s.data(); }
  /// z, after the way up.
  Block<K>* result() { return work_[0].u.data(); }
  /// A place for what is computed from z: the last loop on the way up may write its chunk, and the first on the way
  /// down read it. In between, and only there, the cycle itself needs it.
  Block<K>* from_z() { return work_[0].t.data(); }

  /// loop(chunk) for the chunks of the finest level, in parallel.
  template <class Loop>
  void for_chunks(const Loop& loop) {
    workers_.run(hierarchy_.levels[0].chunks, [&loop](int, int chunk) { loop(chunk); });
  }
  /// The way down, from a start() that is there.
  void down() {
    if (work_.size() > 1) descend(0);
  }
  /// The same, after first(chunk) has filled the chunk's start().
  template <class First>
  void down(const First& first) {
    if (work_.size() > 1) {
      descend(0, first);
    } else {
      for_chunks(first);
    }
  }

  /// last(chunk, ahead) may read z of the chunk and of its neighbours' rows, and write from_z() of the chunk; it may
  /// ask for what is ahead.
  template <class Last>
  void up(const Last& last) {
    for (std::size_t k = 1; k < twice_; ++k) descend(k);
    correct_twice();
    for (std::size_t k = twice_; k-- > 1;) ascend(k);
    if (work_.size() > 1) {
      ascend(0, last);
    } else {
      for_chunks([&last](int chunk) { last(chunk, Ahead()); });
    }
  }

 private:
  struct Work {
    Blocks<K> s, u, t;  // the residual's step, the correction, what is between them
  };
  // The level that is corrected twice has at most this part of the finest level's rows: few percent of the work, in the
  // cache, for one iteration of twenty less, and two of fifteen where a mesh is stretched.
  static constexpr int kTwice = 40;

  // first(chunk) goes through several arrays as fast as the memory gives them: nothing can be asked for beside it.
  template <class First>
  void descend(std::size_t k, const First& first) {
    hierarchy_.levels[k].down.run(
        workers_, [&first](int chunk, int) { first(chunk); },
        [this, k](int chunk, int) { residual_after_start(k, chunk, Ahead()); },
        [this, k](int chunk, int) { restrict_residual(k, chunk); });
  }
  void descend(std::size_t k);
  template <class Last>
  void ascend(std::size_t k, const Last& last) {
    hierarchy_.levels[k].up.run(
        workers_, [this, k](int chunk, int) { carry_up(k, chunk); },
        [this, k](int chunk, int) { smooth(k, chunk, Ahead()); },
        [this, k, &last](int chunk, int next) { last(chunk, ahead_up(k, next)); });
  }
  void ascend(std::size_t k);
  template <class Last>
  void correct(std::size_t k, const Last& last);
  void correct_twice();
  Ahead ahead_up(std::size_t level, int next) const;
  void residual_after_start(std::size_t level, int chunk, const Ahead& ahead);
  void restrict_residual(std::size_t level, int chunk);
  void solve_coarsest();
  void carry_up(std::size_t level, int chunk);
  void smooth(std::size_t level, int chunk, const Ahead& ahead);

  const Hierarchy& hierarchy_;
  Workers& workers_;
  Block<K> natural_ = Block<K>::Ones();
  std::vector<Work> work_;
  std::size_t twice_ = 0;  // the level that is corrected twice, or the coarsest one
  Blocks<K> first_;        // correction of that level
};

extern template class Cycle<2>;
extern template class Cycle<4>;
extern template class Cycle<8>;

}  // namespace holomorph::solver
