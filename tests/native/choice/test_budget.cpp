#include "choice/request.h"

#include <gtest/gtest.h>

namespace holomorph::choice {
namespace {

constexpr double kMost = 1e6;  // of the budget below

TEST(Budget, AddsUpWhatIsSpentWithinOnce) {
  Budget budget(0, 1e-3);
  const auto expect_left = [&](double spent) {
    EXPECT_TRUE(budget.allows(kMost - spent - 1));
    EXPECT_FALSE(budget.allows(kMost - spent));
    EXPECT_TRUE(budget.allows(kMost - spent, 2));
  };
  {
    const Budget::Counting counting(budget);
    EXPECT_TRUE(budget.goes_on());
    Execution::count(1000);
    {
      const Budget::Counting within(budget);
      Execution::count(500);
    }
    expect_left(1500);
    Execution::count(20);
  }
  expect_left(1520);
  Execution::count(1e5);  // is not the budget's
  expect_left(1520);
  {
    const Budget::Counting counting(budget);
    Execution::count(7);
  }
  expect_left(1527);
}

TEST(Budget, GrowsWithTrianglesAndEffort) {
  EXPECT_TRUE(Budget(1000).allows(1.19e9));
  EXPECT_FALSE(Budget(1000).allows(1.2e9));
  EXPECT_FALSE(Budget(1000, 0.5).allows(0.6e9));
  EXPECT_EQ(Budget(100'000).allows(2e10), Budget(1'000'000).allows(2e10));
}

TEST(Budget, SaysWhetherSomethingWasLeftOut) {
  Budget budget(0, 1e-3);
  EXPECT_FALSE(budget.allows(kMost));
  EXPECT_FALSE(budget.was_short());
  EXPECT_FALSE(budget.goes_on(kMost));
  EXPECT_TRUE(budget.goes_on());
  EXPECT_TRUE(budget.was_short());
}

}  // namespace
}  // namespace holomorph::choice
