#include "choice/side_by_side.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace holomorph::choice {
namespace {

constexpr int kLarge = 20'000;

TEST(SideBySide, LargePartsHaveAllThreadsFirstAndTheSmallOneEach) {
  const std::vector<int> sizes{5, 700, 30, kLarge + 1, 12, kLarge, 90};
  for (const int threads : {1, 2, 7}) {
    std::mutex mutex;
    std::vector<int> begun, asked(sizes.size());
    Execution execution(threads);
    execution.stage("maps", 0.0, 1.0);
    side_by_side(sizes, execution, [&](int k, Execution& own) {
      const std::lock_guard lock(mutex);
      begun.push_back(k);
      asked[static_cast<std::size_t>(k)] += own.threads();
    });
    EXPECT_EQ(asked, (std::vector<int>{1, 1, 1, threads, 1, threads, 1})) << threads;
    EXPECT_EQ((std::vector<int>{begun[0], begun[1]}), (std::vector<int>{3, 5}));
    if (threads == 1) {
      EXPECT_EQ(begun, (std::vector<int>{3, 5, 1, 6, 2, 4, 0}));
    }
  }
}

TEST(SideBySide, NothingIsDoneWithoutParts) {
  Execution execution(2);
  side_by_side({}, execution, [](int, Execution&) { FAIL(); });
}

// Whatever the order in which they are met: part 4 is the largest, and waits until part 2 has failed, or is begun
// alone.
TEST(SideBySide, OfSeveralErrorsTheFirstByPartIsThrown) {
  std::atomic<bool> has_failed{false};
  Execution execution(2);
  execution.stage("maps", 0.0, 1.0);
  try {
    side_by_side({1, 1, 8, 1, 9, 1}, execution, [&](int k, Execution&) {
      if (k == 4) {
        while (!has_failed) std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        throw std::runtime_error("part 4");
      }
      if (k == 2) {
        has_failed = true;
        throw std::runtime_error("part 2");
      }
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), std::string("part 2"));
  }
}

class Watched : public testing::TestWithParam<std::vector<int>> {
 protected:
  // Parts that take some time, and ask whether to go on.
  static void work(int, Execution& own) {
    for (int step = 0; step < 5; ++step) {
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
      own.report(step / 5.0);
    }
  }
};

TEST_P(Watched, ProgressGrowsInTheCallingThread) {
  std::vector<double> told;
  const std::thread::id caller = std::this_thread::get_id();
  Execution execution(2, [&](double fraction, const std::string&) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    told.push_back(fraction);
    return true;
  });
  execution.stage("maps", 0.0, 1.0);
  side_by_side(GetParam(), execution, work);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  ASSERT_FALSE(told.empty());
  EXPECT_LE(told.back(), 1);
  EXPECT_TRUE(std::ranges::any_of(told, [](double fraction) { return 0 < fraction && fraction < 1; }));
}

TEST_P(Watched, IsCancelledWhileItWorks) {
  Execution execution(2, [](double fraction, const std::string&) { return fraction == 0; });
  execution.stage("maps", 0.0, 1.0);
  std::atomic<int> ended{0};
  EXPECT_THROW(side_by_side(GetParam(), execution,
                            [&](int k, Execution& own) {
                              for (int repeated = 0; repeated < 8; ++repeated) work(k, own);
                              ++ended;
                            }),
               Cancelled);
  EXPECT_EQ(ended, 0);  // none that was begun was waited for
}

INSTANTIATE_TEST_SUITE_P(SideBySide, Watched,
                         testing::Values(std::vector<int>(8, 1), std::vector<int>(3, kLarge),
                                         std::vector<int>{kLarge, 1, 1}));

}  // namespace
}  // namespace holomorph::choice
