// Memory for large arrays that are read over and over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

#include "base/large_pages.h"

namespace holomorph {

/// Allocates large arrays on pages of 2 MB where the system has them, and leaves new elements as they are: filling with
/// zeros would be a pass over memory of its own.
template <class T>
struct PageAllocator {
  using value_type = T;

  PageAllocator() = default;
  template <class U>
  explicit PageAllocator(const PageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(count));
    if (large(count)) advise_large_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(count)); }

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
  static std::align_val_t alignment(std::size_t count) { return std::align_val_t{large(count) ? kLargePage : 64}; }
};

template <class T>
using Array = std::vector<T, PageAllocator<T>>;

}  // namespace holomorph
