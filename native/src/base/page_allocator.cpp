#include "base/page_allocator.h"

#include <cstdint>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace holomorph {

#ifdef __linux__
namespace {

std::uintptr_t rounded_up(std::uintptr_t bytes) { return (bytes + kLargePage - 1) & ~(kLargePage - 1); }

}  // namespace

void advise_large_pages(void* memory, std::size_t bytes) {
  const auto begin = reinterpret_cast<std::uintptr_t>(memory), first = rounded_up(begin);
  const auto end = (begin + bytes) & ~(kLargePage - 1);
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

void* take_large_pages(std::size_t bytes) {
  const std::size_t size = rounded_up(bytes);
  void* const given = mmap(nullptr, size + kLargePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (given == MAP_FAILED) throw std::bad_alloc();
  char* const begin = static_cast<char*>(given);
  const std::size_t before =
      rounded_up(reinterpret_cast<std::uintptr_t>(given)) - reinterpret_cast<std::uintptr_t>(given);
  if (before > 0) munmap(begin, before);
  if (before < kLargePage) munmap(begin + before + size, kLargePage - before);
  advise_large_pages(begin + before, size);
  return begin + before;
}

void free_large_pages(void* memory, std::size_t bytes) noexcept { munmap(memory, rounded_up(bytes)); }

#else

void advise_large_pages(void*, std::size_t) {}
void* take_large_pages(std::size_t bytes) { return ::operator new (bytes, std::align_val_t{kLargePage}); }
void free_large_pages(void* memory, std::size_t) noexcept { ::operator delete (memory, std::align_val_t{kLargePage}); }

#endif

}  // namespace holomorph
