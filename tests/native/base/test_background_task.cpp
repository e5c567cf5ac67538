#include "base/background_task.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/workers.h"

namespace holomorph {
namespace {

// Goes on until it is cancelled.
void run_until_cancelled(Execution& execution) {
  for (;;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    execution.report(0.5);
  }
}

class BackgroundTaskOf : public testing::TestWithParam<int> {
 protected:
  Execution execution_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, BackgroundTaskOf, testing::Values(1, 2, 4));

// Where there is more than one thread: otherwise it is done where it is begun.
class BackgroundTaskBeside : public BackgroundTaskOf {};
INSTANTIATE_TEST_SUITE_P(Threads, BackgroundTaskBeside, testing::Values(2, 4));

TEST_P(BackgroundTaskOf, TheResultIsThereAfterTheWait) {
  for (int run = 0; run < 50; ++run) {
    std::vector<int> result;
    BackgroundTask task([&](Execution&) { result.assign(1000, run); }, execution_);
    task.wait(execution_);
    EXPECT_EQ(result, std::vector<int>(1000, run));
  }
}

TEST_P(BackgroundTaskOf, ItHasAnExecutionWithAsManyThreads) {
  int threads = 0;
  Execution* given = nullptr;
  std::thread::id id;
  BackgroundTask task(
      [&](Execution& own) {
        threads = own.threads();
        given = &own;
        id = std::this_thread::get_id();
      },
      execution_);
  task.wait(execution_);
  EXPECT_EQ(threads, GetParam());
  EXPECT_EQ(given == &execution_, GetParam() == 1);  // with one thread it is done here and now
  EXPECT_EQ(id == std::this_thread::get_id(), GetParam() == 1);
}

TEST_P(BackgroundTaskOf, LoopsOfBothAreDone) {
  constexpr int kRows = 5 * kChunk;
  std::vector<int> mine(kRows, 0), others(kRows, 0);
  BackgroundTask task(
      [&](Execution& own) {
        for (int loop = 0; loop < 100; ++loop) for_rows(own.workers(), kRows, [&](int i) { ++others[i]; });
      },
      execution_);
  for (int loop = 0; loop < 100; ++loop) for_rows(execution_.workers(), kRows, [&](int i) { ++mine[i]; });
  task.wait(execution_);
  EXPECT_EQ(mine, std::vector<int>(kRows, 100));
  EXPECT_EQ(others, mine);
}

TEST_P(BackgroundTaskOf, WhatItThrowsIsHeard) {
  const auto run = [&] {
    BackgroundTask task([](Execution&) { throw std::domain_error("mine"); }, execution_);
    task.wait(execution_);
  };
  EXPECT_THROW(run(), std::domain_error);
}

TEST_P(BackgroundTaskBeside, WhatADroppedOneThrowsIsNotHeard) {
  {
    const BackgroundTask task([](Execution&) { throw std::domain_error("mine"); }, execution_);
  }
}

TEST_P(BackgroundTaskBeside, ADroppedOneIsCancelled) {
  bool cancelled = false;
  {
    const BackgroundTask task(
        [&](Execution& own) {
          try {
            run_until_cancelled(own);
          } catch (const Cancelled&) {
            cancelled = true;
            throw;
          }
        },
        execution_);
  }
  EXPECT_TRUE(cancelled);
}

TEST(BackgroundTask, WaitingIsCancelledByTheCallersFunction) {
  int calls = 0;
  Execution execution(2, [&](double, const std::string&) { return ++calls < 3; });
  bool ended = false;
  {
    BackgroundTask task(
        [&](Execution& own) {
          try {
            run_until_cancelled(own);
          } catch (const Cancelled&) {
            ended = true;
          }
        },
        execution);
    EXPECT_THROW(task.wait(execution), Cancelled);
  }
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace holomorph
