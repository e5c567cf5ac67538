// Several loops over the same rows, each begun before the one before is over, while its rows are still in the cache.
#pragma once

#include <tuple>
#include <utility>

#include "base/chunks.h"

namespace holomorph::solver {

/// Rows in chunks of equal size, the last ones shorter or empty.
struct Chunks {
  int rows = 0;
  int each = 1;

  int begin(int chunk) const { return std::min(chunk * each, rows); }
  int end(int chunk) const { return std::min((chunk + 1) * each, rows); }
};

/// Rows of a chunk of a wavefront: few, so that what several loops touch of some neighbouring chunks fits into the
/// cache of one processor.
inline constexpr int kWaveRows = 512;

inline int wave_chunks(int rows) { return (rows + kWaveRows - 1) / kWaveRows; }

/// For every chunk of a loop the chunks of the loop before whose results it reads, without order.
using Needs = std::vector<std::vector<int>>;

/// The order in which the chunks of up to three loops are done. Every thread goes through segments of consecutive
/// chunks: it does the next chunk of the first loop, then those of the later loops that need no more than what it has
/// just done. Those that need another segment are left for the end. Where rows that need each other have numbers near
/// each other this keeps the rows in the cache from loop to loop; elsewhere it costs nothing. As each row is written by
/// one chunk of one loop, and sums are kept by chunk, the results do not depend on the order.
class Wavefront {
 public:
  static constexpr int kNone = -1;

  Wavefront() = default;
  /// @param needs of the second loop, the third ...
  Wavefront(int chunks, const std::vector<const Needs*>& needs, int threads);

  /// Calls loop(chunk, next) for every chunk of every loop, none before those that it needs; `next` is the chunk that
  /// the first loop will do next on this thread, or kNone. @pre loops do not throw
  template <class... Loops>
  void run(Workers& workers, const Loops&... loops) const {
    const auto call = [&](const Step& step) {
      int number = 0;
      ((number++ == step.loop ? loops(step.chunk, step.next) : void()), ...);
    };
    constexpr int kAnyNumber = 0;  // of segments is worth a second thread
    workers.run(
        static_cast<int>(segments_.size()),
        [&](int, int segment) {
          for (const Step& step : segments_[segment]) call(step);
        },
        kAnyNumber);
    for (int loop = 0; loop < static_cast<int>(left_.size()); ++loop) {
      const std::vector<int>& left = left_[loop];
      workers.run(static_cast<int>(left.size()), [&](int, int k) { call({loop, left[k], kNone}); });
    }
  }

 private:
  struct Step {
    int loop, chunk, next;
  };
  std::vector<std::vector<Step>> segments_;
  std::vector<std::vector<int>> left_;  // chunks per loop
};

}  // namespace holomorph::solver
