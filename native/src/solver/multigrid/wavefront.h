// Several loops over the same rows, interleaved: each starts before the previous one has ended, while its rows are
// still in the cache.
#pragma once

#include <vector>

#include "solver/multigrid/sparse_rows.h"

namespace holomorph::solver {

/// For every chunk of a loop the chunks of the loop before whose results it reads.
using ChunkNeeds = std::vector<std::vector<int>>;

/// Lists the chunks of kChunkRows in which the rows of M have columns, for `chunks` chunks of `each` rows.
/// Cost: linear, in parallel.
ChunkNeeds chunk_needs(const SparseRows& M, int each, int chunks, Workers& workers);

/// Adds the inverse relation: where d needs c, c needs d, too.
ChunkNeeds symmetrised(const ChunkNeeds& needs);

/// The order in which the chunks of several loops are done. Every thread goes through segments of consecutive chunks.
/// It does the next chunk of the first loop, then those of the later loops that need no more than what is done in the
/// segment. Those that need another segment are left for the end. As each row is written by one chunk of one loop, and
/// sums are kept by chunk, the results do not depend on the order.
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

}  // namespace holomorph::solver
