// Memory for large arrays that are read over and over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

#include "base/large_pages.h"

namespace holomorph {

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
