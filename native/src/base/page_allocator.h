// Memory for large arrays that are read over and over: pages of 2 MB, prefetch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

namespace holomorph {

/// Advises the processor to fetch what lies at `address`. Any address will do: the advice never fails.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(address);
#endif
}

/// Page size of large arrays in bytes, where the system has it.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// Advises the system to use large pages where whole ones lie in the memory. This saves misses of the address cache,
/// and 511 of 512 page faults. Has no effect where the system refuses.
void advise_large_pages(void* memory, std::size_t bytes);

/// Allocates uninitialised memory at a multiple of kLargePage, which goes back to the system as soon as it is freed.
/// The heap would keep it, and a computation takes and frees many large arrays of different sizes.
/// @throws std::bad_alloc
void* take_large_pages(std::size_t bytes);

/// Frees what take_large_pages(bytes) returned.
void free_large_pages(void* memory, std::size_t bytes) noexcept;

/// Allocates large arrays on pages of 2 MB where the system has them. New elements are not initialised: filling with
/// zeros would be a pass over memory of its own.
template <class T>
struct PageAllocator {
  using value_type = T;

  PageAllocator() = default;
  template <class U>
  explicit PageAllocator(const PageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(large(count) ? take_large_pages(bytes) : ::operator new(bytes, kAlignment));
  }
  void deallocate(T* memory, std::size_t count) {
    if (large(count)) {
      free_large_pages(memory, count * sizeof(T));
    } else {
      ::operator delete(memory, kAlignment);
    }
  }

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class Argument>
  void construct(U* place, Argument&& argument) {
    ::new (static_cast<void*>(place)) U(std::forward<Argument>(argument));
  }

  bool operator==(const PageAllocator&) const { return true; }

 private:
  static bool large(std::size_t count) { return count * sizeof(T) >= kLargePage / 2; }
  static constexpr std::align_val_t kAlignment{64};
};

template <class T>
using Array = std::vector<T, PageAllocator<T>>;

}  // namespace holomorph
