// Large arrays: where they lie, and that threads may take and give them at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <thread>

#include "base/page_allocator.h"

namespace holomorph {
namespace {

TEST(PageAllocator, LargeArraysBeginAtALargePage) {
  const Array<double> large(kLargePage / sizeof(double)), small(100);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % kLargePage, 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(small.data()) % 64, 0U);
}

TEST(PageAllocator, AnyPartOfMemoryMayBeAdvised) {
  std::vector<char> bytes(3 * kLargePage, 7);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kLargePage, bytes.size()})
    advise_large_pages(bytes.data() + 1, size == bytes.size() ? size - 1 : size);
  EXPECT_EQ(std::accumulate(bytes.begin(), bytes.end(), std::size_t{0}), 7 * bytes.size());
}

TEST(PageAllocator, SeveralThreadsTakeAndGiveAtOnce) {
  std::vector<std::thread> threads;
  std::vector<int> right(4, 0);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t, &right] {
      for (int round = 1; round <= 8; ++round) {
        Array<int> values(round * kLargePage / sizeof(int));
        std::fill(values.begin(), values.end(), t);
        values.resize(values.size() + 1, t);
        right[t] += std::count(values.begin(), values.end(), t) == static_cast<std::ptrdiff_t>(values.size());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, std::vector<int>(4, 8));
}

}  // namespace
}  // namespace holomorph
