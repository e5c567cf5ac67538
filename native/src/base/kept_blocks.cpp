#include "base/kept_blocks.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace holomorph {
namespace {

struct Block {
  void* memory;
  std::size_t bytes;
  bool used;
};

// The blocks in use and those kept: few enough to be searched one by one.
class Blocks {
 public:
  void begin_keeping() {
    const std::lock_guard lock(mutex_);
    ++keepers_;
  }

  void end_keeping() noexcept {
    const std::lock_guard lock(mutex_);
    if (--keepers_ == 0) free_kept(SIZE_MAX);
  }

  void* take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    Block* best = nullptr;
    for (Block& block : blocks_) {
      const bool fits = !block.used && block.bytes >= bytes && block.bytes - bytes <= bytes / 8;
      if (fits && (best == nullptr || block.bytes < best->bytes)) best = &block;
    }
    if (best == nullptr) best = make(bytes);
    best->used = true;
    return best->memory;
  }

  void give(void* memory) noexcept {
    const std::lock_guard lock(mutex_);
    const auto block = std::find_if(blocks_.begin(), blocks_.end(), [=](const Block& b) { return b.memory == memory; });
    block->used = false;
    if (keepers_ == 0) free_kept(SIZE_MAX);
  }

 private:
  static constexpr std::align_val_t kAlignment{kLargePage};

  Block* make(std::size_t bytes) {
    free_kept(bytes);
    blocks_.reserve(blocks_.size() + 1);
    void* memory = ::operator new(bytes, kAlignment, std::nothrow);
    if (memory == nullptr) {
      free_kept(SIZE_MAX);
      memory = ::operator new(bytes, kAlignment);
    }
    advise_large_pages(memory, bytes);
    return &blocks_.emplace_back(Block{memory, bytes, false});
  }

  // Gives back blocks that are not in use, the oldest first, until they are `bytes` together or none is left.
  void free_kept(std::size_t bytes) noexcept {
    std::size_t freed = 0;
    std::erase_if(blocks_, [&](const Block& block) {
      if (block.used || freed >= bytes) return false;
      freed += block.bytes;
      ::operator delete(block.memory, kAlignment);
      return true;
    });
  }

  std::mutex mutex_;
  int keepers_ = 0;
  std::vector<Block> blocks_;
};

Blocks& blocks() {
  static Blocks& result = *new Blocks;  // outlives whatever is freed at the end of the program
  return result;
}

}  // namespace

KeptBlocks::KeptBlocks() { blocks().begin_keeping(); }
KeptBlocks::~KeptBlocks() { blocks().end_keeping(); }

void* take_block(std::size_t bytes) { return blocks().take(bytes); }
void give_block(void* memory) noexcept { blocks().give(memory); }

#ifdef __linux__
void advise_large_pages(void* memory, std::size_t bytes) {
  const auto begin = reinterpret_cast<std::uintptr_t>(memory), first = (begin + kLargePage - 1) & ~(kLargePage - 1);
  const auto end = (begin + bytes) & ~(kLargePage - 1);
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}
#else
void advise_large_pages(void*, std::size_t) {}
#endif

}  // namespace holomorph
