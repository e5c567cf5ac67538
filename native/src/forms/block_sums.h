// Sums over the elements of a mesh in parallel. A block's sum has a fixed order, and blocks are added in their order:
// the same bits for any number of threads.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/chunks.h"
#include "base/execution.h"

namespace holomorph::forms {

/// Elements per block.
inline constexpr int kBlock = 4096;
/// Blocks that run in parallel before their sums are added and the progress function is called.
inline constexpr int kBatch = 16;

/// Runs `work(slot, begin, end)` on all blocks, batch by batch, and after each batch `collect(slot)` in the order of
/// its blocks; slots are 0 .. kBatch - 1. @param from,to of the progress function
template <class Work, class Collect>
void for_blocks(std::size_t elements, Execution& execution, double from, double to, Work work, Collect collect) {
  Workers& workers = execution.workers();
  const int blocks = static_cast<int>((elements + kBlock - 1) / kBlock);
  for (int first = 0; first < blocks; first += kBatch) {
    const int count = std::min(kBatch, blocks - first);
    run_throwing(workers, count, [&](int slot) {
      const std::size_t begin = static_cast<std::size_t>(first + slot) * kBlock;
      work(slot, static_cast<int>(begin), static_cast<int>(std::min(elements, begin + kBlock)));
    });
    for (int slot = 0; slot < count; ++slot) collect(slot);
    execution.report(from + (to - from) * (first + count) / blocks);
  }
}

}  // namespace holomorph::forms
