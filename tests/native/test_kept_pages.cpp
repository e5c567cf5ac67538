#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "base/kept_pages.h"
#include "base/page_allocator.h"

namespace holomorph {
namespace {

// Sizes around those of a page, among them some that leave pages of several arrays side by side.
constexpr std::size_t kSizes[] = {1, kLargePage - 1, kLargePage, kLargePage + 1, 5 * kLargePage, 3 * kLargePage - 7};

void fill(unsigned char* memory, std::size_t bytes, unsigned seed) {
  for (std::size_t i = 0; i < bytes; i += 997) memory[i] = static_cast<unsigned char>(seed + i % 251);
  memory[bytes - 1] = static_cast<unsigned char>(seed);
}

bool is_filled(const unsigned char* memory, std::size_t bytes, unsigned seed) {
  for (std::size_t i = 0; i + 1 < bytes; i += 997) {
    if (memory[i] != static_cast<unsigned char>(seed + i % 251)) return false;
  }
  return memory[bytes - 1] == static_cast<unsigned char>(seed);
}

// Takes and gives back arrays in changing orders; whether each kept what was written into it.
bool takes_and_gives(unsigned seed, int rounds) {
  bool kept = true;
  std::vector<std::pair<unsigned char*, std::size_t>> taken;
  for (int round = 0; round < rounds; ++round) {
    for (const std::size_t bytes : kSizes) {
      taken.emplace_back(static_cast<unsigned char*>(take_pages(bytes)), bytes);
      kept = kept && reinterpret_cast<std::uintptr_t>(taken.back().first) % kLargePage == 0;
      fill(taken.back().first, bytes, seed);
    }
    if (round % 2 == 0) std::reverse(taken.begin(), taken.end());
    const std::size_t rest = round + 1 < rounds ? 3 : 0;
    for (; taken.size() > rest; taken.pop_back()) {
      kept = kept && is_filled(taken.back().first, taken.back().second, seed);
      give_pages(taken.back().first, taken.back().second);
    }
  }
  return kept;
}

TEST(KeptPages, MemoryKeepsWhatIsWrittenIntoIt) {
  EXPECT_TRUE(takes_and_gives(1, 3));
  const KeptPages pages;
  EXPECT_TRUE(takes_and_gives(2, 5));
}

TEST(KeptPages, SeveralThreadsTakeAndGiveAtOnce) {
  constexpr int kThreads = 4;
  std::vector<char> kept(kThreads, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([t, &kept] {
      const KeptPages pages(t % 2 == 0 ? 20 * kLargePage : 0, 2);
      kept[t] = static_cast<char>(takes_and_gives(10 * t, 5));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(kept, std::vector<char>(kThreads, 1));
}

TEST(KeptPages, PagesMayBeGivenByAnotherThread) {
  const KeptPages pages;
  auto* const memory = static_cast<unsigned char*>(take_pages(5 * kLargePage));
  fill(memory, 5 * kLargePage, 3);
  bool kept = false;
  std::thread([&] {
    kept = is_filled(memory, 5 * kLargePage, 3);
    give_pages(memory, 5 * kLargePage);
  }).join();
  EXPECT_TRUE(kept);
  EXPECT_TRUE(takes_and_gives(4, 2));
}

TEST(KeptPages, MakingAheadEndsWithTheOneThatWantsIt) {
  for (int i = 0; i < 20; ++i) const KeptPages pages(64 * kLargePage, 2);
}

TEST(PageAllocator, SmallAndLargeArraysGrow) {
  Array<int> numbers;
  constexpr int kCount = 3'000'000;
  for (int i = 0; i < kCount; ++i) numbers.push_back(i);
  const Array<int> copy = numbers;
  numbers = {};
  ASSERT_EQ(copy.size(), static_cast<std::size_t>(kCount));
  for (int i = 0; i < kCount; i += 1001) ASSERT_EQ(copy[i], i);
  EXPECT_EQ(copy.back(), kCount - 1);
}

TEST(PageAllocator, ElementsThatAreAskedForAreThere) {
  const Array<double> ones(500'000, 1.0);
  EXPECT_EQ(std::accumulate(ones.begin(), ones.end(), 0.0), 500'000.0);
}

}  // namespace
}  // namespace holomorph
