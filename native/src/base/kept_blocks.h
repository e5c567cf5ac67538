// Memory for large arrays that goes from one to the next without a way through the system.
#pragma once

#include <cstddef>

namespace holomorph {

/// Page size of large arrays, where the system has it.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// While one lives, in any thread, the blocks of large arrays that are freed are kept for the next arrays of about that
/// size. The system writes zeros into a page before it hands it out, which takes as long as several loops over it.
/// Before new memory is taken as much of what is kept is given back, so that the sum stays near what was in use at
/// once. The end of the last one gives back all of it.
class KeptBlocks {
 public:
  KeptBlocks();
  ~KeptBlocks();
  KeptBlocks(const KeptBlocks&) = delete;
  KeptBlocks& operator=(const KeptBlocks&) = delete;
};

/// Advice to the system to use large pages where whole ones lie in the memory: fewer misses of the address cache, and
/// 512 times fewer page faults. Without effect where it is refused.
void advise_large_pages(void* memory, std::size_t bytes);

/// Memory at a multiple of kLargePage, with any content; thread-safe.
/// @throws std::bad_alloc
void* take_block(std::size_t bytes);

/// Frees what take_block() returned.
void give_block(void* memory) noexcept;

}  // namespace holomorph
