// The levels of the multigrid preconditioner: an algebraic relative of the paper's progressive mesh (§ 3).
//
// Moving an F-point to the C-neighbour of largest weight is an edge collapse, and a step of coarsening is a batch of
// them. So the hierarchy is a progressive mesh, read by batches of vertex splits. Two things differ. The steps see the
// matrix alone, so no coarse mesh has to be valid. A value is interpolated from several coarse ones (P), not from the
// parent's alone, and coarse operators are P^T A P.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/laplace_solver.h"
#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {

/// For every chunk of a loop the chunks of the loop before whose results it reads.
using ChunkNeeds = std::vector<std::vector<int>>;

/// Several loops over the same rows, interleaved: each starts before the previous one has ended, while its rows are
/// still in the cache. This is the order in which their chunks are done. Every thread goes through segments of
/// consecutive chunks. It does the next chunk of the first loop, then those of the later loops that need no more than
/// what is done in the segment. Those that need another segment are left for the end. As each row is written by one
/// chunk of one loop, and sums are kept by chunk, the results do not depend on the order.
class Wavefront {
 public:
  Wavefront() = default;
  /// @param needs of the second loop, the third ...
  Wavefront(int chunks, const std::vector<ChunkNeeds>& needs, int threads);

  /// Calls loop(chunk) for every chunk of every loop, none before those that it needs. @pre loops do not throw
  template <class... Loops>
  void run(Workers& workers, const Loops&... loops) const {
    const auto call = [&](int loop, int chunk) {
      int number = 0;
      ((number++ == loop ? loops(chunk) : void()), ...);
    };
    constexpr int kAnyNumber = 0;  // any number of segments is worth a second thread
    workers.run(
        static_cast<int>(segments_.size()),
        [&](int, int segment) {
          for (const Step& step : segments_[segment]) call(step.loop, step.chunk);
        },
        kAnyNumber);
    for (int loop = 0; loop < static_cast<int>(sizeof...(Loops)); ++loop) {
      const std::vector<int>& left = left_[loop];
      workers.run(static_cast<int>(left.size()), [&](int, int k) { call(loop, left[k]); });
    }
  }

 private:
  struct Step {
    int loop, chunk;
  };
  std::vector<std::vector<Step>> segments_;
  std::vector<std::vector<int>> left_;  // chunks per loop
};

struct CoarsestInverse {
  Eigen::MatrixXf natural;    ///< pseudo-inverse of A
  Eigen::MatrixXf dirichlet;  ///< inverse of the part of A without the fixed vertices, 0 at these; empty without any
};

struct Level {
  Operator op;
  EqualRows P;     ///< interpolation from the next level; rows sum to 1; empty on the coarsest level
  SparseRows R;    ///< restriction to the next level, its transpose; like what follows empty on the coarsest level
  Wavefront down;  ///< a loop over the rows, and one that applies R to its results
  Wavefront up;    ///< a loop over the rows, one that applies A to its results, and one more that applies A to those

  int rows() const { return op.A.size(); }
};

/// Rows of the next level that go with a chunk of this level's.
inline int coarse_rows_per_chunk(const Level& level) {
  const int chunks = row_chunks(level.rows());
  return (level.R.size() + chunks - 1) / chunks;
}

/// One hierarchy serves both conditions. The fixed vertices of a coarse level are fixed on the finer one, too, and a
/// fixed vertex takes its value from fixed ones alone. So a function that is 0 at the fixed vertices of one level is 0
/// at those of all.
struct Hierarchy {
  std::vector<Level> levels;  ///< finest first
  CoarsestInverse coarsest;
};

/// Coarsens until 250 vertices are left.
/// @param fixed vertices, distinct
/// @throws SolverError if the graph cannot be coarsened further or the matrix is not semi-definite; Cancelled
/// Cost: linear; about 0.2 KB and 0.5 us per vertex.
Hierarchy make_hierarchy(const Laplacian& L, const std::vector<int>& fixed, Execution& execution);

}  // namespace holomorph::solver
