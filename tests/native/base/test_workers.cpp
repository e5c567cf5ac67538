#include "base/workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>
#include <tuple>
#include <vector>

// What tasks write is not atomic on purpose: a chunk that is done twice at once, or a number of a thread that two have,
// or a result that the caller sees too early, is a data race, which ThreadSanitizer reports.

namespace holomorph {
namespace {

using std::chrono::milliseconds;

constexpr int kShareAll = 0;  // too_few: one chunk is worth waking a thread for

// Waits for what another thread does; false where it has not come in much longer than any machine takes.
template <class Condition>
bool comes_true(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

class WorkersAndChunks : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(WorkersAndChunks, EveryChunkIsDoneOnce) {
  const auto [threads, chunks] = GetParam();
  Workers workers(threads);
  std::vector<int> done(chunks, 0);
  workers.run(
      chunks, [&](int, int chunk) { ++done[chunk]; }, kShareAll);
  EXPECT_EQ(done, std::vector<int>(chunks, 1));
}

TEST_P(WorkersAndChunks, ThreadsHaveNumbersOfTheirOwn) {
  const auto [threads, chunks] = GetParam();
  Workers workers(threads);
  ASSERT_EQ(workers.count(), threads);
  std::vector<int> done(threads, 0);
  std::vector<std::thread::id> ids(threads);
  std::vector<char> moved(threads, 0);
  workers.run(
      chunks,
      [&](int thread, int) {
        if (done.at(thread)++ == 0) ids[thread] = std::this_thread::get_id();
        moved[thread] |= ids[thread] != std::this_thread::get_id();
      },
      kShareAll);
  EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), chunks);
  EXPECT_EQ(moved, std::vector<char>(threads, 0));
  if (done[0] > 0) {
    EXPECT_EQ(ids[0], std::this_thread::get_id());
  }
}

INSTANTIATE_TEST_SUITE_P(All, WorkersAndChunks,
                         testing::Combine(testing::Values(1, 2, 4, 8), testing::Values(0, 1, 2, 3, 7, 1000, 100'000)));

class WorkersOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, WorkersOf, testing::Values(1, 2, 4, 8));

TEST_P(WorkersOf, ThousandsOfShortLoopsEachSeeTheOneBefore) {
  constexpr int kLoops = 4000;
  Workers workers(GetParam());
  for (const int chunks : {3, 17}) {
    std::vector<int> now(chunks, 0), next(chunks, 0);
    for (int loop = 0; loop < kLoops; ++loop) {
      workers.run(chunks, [&](int, int chunk) { next[chunk] = now[(chunk + 1) % chunks] + 1; });
      now.swap(next);
    }
    EXPECT_EQ(now, std::vector<int>(chunks, kLoops));
  }
}

TEST_P(WorkersOf, LoopsOfChangingLength) {
  Workers workers(GetParam());
  std::vector<int> done(64, 0), expected(64, 0);
  for (int loop = 0; loop < 2000; ++loop) {
    const int chunks = loop * 37 % 65;
    workers.run(
        chunks, [&](int, int chunk) { ++done[chunk]; }, kShareAll);
    for (int chunk = 0; chunk < chunks; ++chunk) ++expected[chunk];
  }
  EXPECT_EQ(done, expected);
}

TEST_P(WorkersOf, ThreadsThatSleepAreWokenAgain) {
  Workers workers(GetParam());
  int done = 0;
  for (int loop = 0; loop < 20; ++loop) {
    std::this_thread::sleep_for(milliseconds(2));  // a hundred times what a thread looks before it sleeps
    std::vector<int> each(8, 0);
    workers.run(8, [&](int, int chunk) { each[chunk] = 1; });
    done += std::accumulate(each.begin(), each.end(), 0);
  }
  EXPECT_EQ(done, 20 * 8);
}

TEST_P(WorkersOf, TheCallerWaitsForChunksThatOthersHaveBegun) {
  Workers workers(GetParam());
  std::vector<int> done(2 * GetParam(), 0);
  workers.run(
      static_cast<int>(done.size()),
      [&](int thread, int chunk) {
        if (thread != 0) std::this_thread::sleep_for(milliseconds(5));
        done[chunk] = 1;
      },
      kShareAll);
  EXPECT_EQ(done, std::vector<int>(done.size(), 1));
}

TEST_P(WorkersOf, AllThreadsWorkAtOnceUnderTheirNumbers) {
  Workers workers(GetParam());
  std::atomic<int> begun{0};
  std::atomic<bool> alone{false};
  std::vector<std::atomic<int>> chunks_of(GetParam());
  workers.run(
      GetParam(),
      [&](int thread, int) {
        ++chunks_of.at(thread);
        ++begun;
        if (!comes_true([&] { return begun == GetParam(); })) alone = true;
      },
      kShareAll);
  EXPECT_FALSE(alone);
  for (const std::atomic<int>& chunks : chunks_of) EXPECT_EQ(chunks, 1);
}

TEST_P(WorkersOf, UnusedOnesEnd) {
  for (int i = 0; i < 100; ++i) {
    const Workers workers(GetParam());
    EXPECT_EQ(workers.count(), GetParam());
  }
}

TEST_P(WorkersOf, OnesThatHaveJustWorkedEnd) {
  int done = 0;
  for (int i = 0; i < 100; ++i) {
    std::vector<int> each(3, 0);
    {
      Workers workers(GetParam());
      workers.run(3, [&](int, int chunk) { each[chunk] = 1; });
    }
    done += std::accumulate(each.begin(), each.end(), 0);
  }
  EXPECT_EQ(done, 300);
}

TEST_P(WorkersOf, OnesThatSleepEnd) {
  Workers workers(GetParam());
  workers.run(3, [](int, int) {});
  std::this_thread::sleep_for(milliseconds(5));
}

TEST(Workers, ZeroIsOneThreadForEachProcessor) {
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  EXPECT_EQ(Workers(0).count(), std::max(1, processors));
}

TEST(Workers, FewChunksAreDoneByTheCallerInOrder) {
  Workers workers(4);
  std::vector<int> order;
  const auto caller = std::this_thread::get_id();
  workers.run(
      5,
      [&](int thread, int chunk) {
        EXPECT_EQ(thread, 0);
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(chunk);
      },
      5);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Workers, SeveralAtOnceDoNotMix) {
  constexpr int kLoops = 500, kChunks = 9;
  std::vector<std::vector<int>> done(3, std::vector<int>(kChunks, 0));
  std::vector<std::thread> callers;
  for (std::vector<int>& mine : done) {
    callers.emplace_back([&mine] {
      Workers workers(3);
      for (int loop = 0; loop < kLoops; ++loop) workers.run(kChunks, [&](int, int chunk) { ++mine[chunk]; });
    });
  }
  for (std::thread& caller : callers) caller.join();
  for (const std::vector<int>& mine : done) EXPECT_EQ(mine, std::vector<int>(kChunks, kLoops));
}

}  // namespace
}  // namespace holomorph
