// What is costly to make is shared by threads: solvers are lent, and values kept.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "base/resource_pool.h"

namespace holomorph {
namespace {

// Counts itself while it lives.
struct Counted {
  explicit Counted(std::atomic<int>& all) : count(all) { ++count; }
  ~Counted() { --count; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

  std::atomic<int>& count;
  int users = 0;
};

TEST(ResourcePool, LendsTheSameOneAgainAndAnotherWhileItIsLent) {
  std::atomic<int> alive = 0, made = 0;
  Execution execution(1);
  {
    const ResourcePool<Counted> lender([&](Execution&) {
      ++made;
      return std::make_unique<Counted>(alive);
    });
    const Counted* first = lender.borrow(execution).get();
    EXPECT_EQ(made, 1);
    {
      const auto again = lender.borrow(execution), beside = lender.borrow(execution);
      EXPECT_EQ(again.get(), first);
      EXPECT_NE(beside.get(), first);
      EXPECT_EQ(made, 2);
      EXPECT_EQ(alive, 2);
    }
    EXPECT_EQ(alive, 1);  // one is kept
  }
  EXPECT_EQ(alive, 0);
}

TEST(ResourcePool, KeepsNothingThatCouldNotBeMade) {
  int tries = 0;
  Execution execution(1);
  const ResourcePool<int> lender([&](Execution&) -> std::unique_ptr<int> {
    if (++tries == 1) throw Cancelled("stopped");
    return std::make_unique<int>(tries);
  });
  EXPECT_THROW(lender.borrow(execution), Cancelled);
  EXPECT_EQ(*lender.borrow(execution), 2);
}

TEST(ResourcePool, HasOneUserAtATime) {
  std::atomic<int> alive = 0, shared = 0;
  const ResourcePool<Counted> lender([&](Execution&) { return std::make_unique<Counted>(alive); });
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      Execution execution(1);
      for (int j = 0; j < 1000; ++j) {
        const auto lent = lender.borrow(execution);
        shared += ++lent->users != 1;
        --lent->users;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(shared, 0);
  EXPECT_EQ(alive, 1);
}

TEST(Newest, MakesAnotherForAnotherKeyAlone) {
  Newest<int, std::shared_ptr<int>> last;
  int made = 0;
  const auto squared = [&](int key) {
    return last.get(key, [&] {
      ++made;
      return std::make_shared<int>(key * key);
    });
  };
  const auto nine = squared(3);
  EXPECT_EQ(squared(3), nine);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(*squared(4), 16);
  EXPECT_EQ(*nine, 9);  // who has it keeps it
  EXPECT_EQ(*squared(3), 9);
  EXPECT_EQ(made, 3);
}

TEST(Newest, IsAskedWhileItMakes) {
  Newest<int, std::shared_ptr<int>> last;
  const auto outer =
      last.get(1, [&] { return std::make_shared<int>(10 * *last.get(1, [] { return std::make_shared<int>(7); })); });
  EXPECT_EQ(*outer, 70);
}

TEST(Newest, DropsTheOneThatWasAskedForBeforeTheOthers) {
  Newest<int, int> two(2);
  int made = 0;
  const auto asked = [&](int key) { return two.get(key, [&] { return ++made; }); };
  EXPECT_FALSE(two.any());
  EXPECT_EQ(asked(1), 1);
  EXPECT_EQ(asked(2), 2);
  EXPECT_EQ(two.any(), 1);
  EXPECT_EQ(asked(1), 1);  // asked for again: now the other is dropped first
  EXPECT_EQ(two.any(), 2);
  EXPECT_EQ(asked(3), 3);
  EXPECT_EQ(asked(1), 1);
  EXPECT_EQ(asked(2), 4);
  two.keep(2, 9);
  EXPECT_EQ(asked(2), 9);
}

}  // namespace
}  // namespace holomorph
