// Pages of memory that go from one large array to the next without a way through the system.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

namespace holomorph {

/// Page size of large arrays, where the system has it.
inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// While one lives, in any thread, the pages of large arrays that are freed are kept for the next. The system writes
/// zeros into a page before it hands it out, which takes as long as several loops over it; a computation on a mesh of
/// millions of faces would take all its memory several times over. No more is kept than was in use before. The end of
/// the last gives all of it back.
class KeptPages {
 public:
  /// @param ahead bytes that the computation is sure to take: a thread of its own has the system make them while the
  /// others still compute, as far as they have not been taken before
  /// @param threads of the computation; with one nothing is made ahead
  explicit KeptPages(std::size_t ahead = 0, int threads = 1);
  ~KeptPages();
  KeptPages(const KeptPages&) = delete;
  KeptPages& operator=(const KeptPages&) = delete;

 private:
  std::atomic<bool> over_{false};
  std::thread ahead_;
};

/// Asks for pages of 2 MB where whole ones lie in the memory: a third fewer misses of the address cache, and 512 times
/// fewer faults when it is first written. Advice only: refused, it lies on small pages.
void advise_large_pages(void* memory, std::size_t bytes);

/// Memory at a multiple of kLargePage, with any content; thread-safe.
/// @throws std::bad_alloc
void* take_pages(std::size_t bytes);

/// Frees what take_pages(bytes) returned.
void give_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace holomorph
