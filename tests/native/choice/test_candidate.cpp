#include "choice/candidate.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/errors.h"
#include "choice/turned_parts.h"

namespace holomorph::choice {
namespace {

constexpr double kMost = 1e6;  // of the budgets below

// Maps of one part by their costs, of seams alone, and the order in which they are made.
class Least : public testing::Test {
 protected:
  MapPointer map(double cost) {
    auto made = std::make_shared<flat::Layout>();
    const auto& polygons = part_->surface->polygons;
    made->uv.resize(static_cast<Eigen::Index>(polygons.corner_vertices.size()), 2);
    for (Eigen::Index c = 0; c < made->uv.rows(); ++c) {
      const auto& point = polygons.vertices[polygons.corner_vertices[static_cast<std::size_t>(c)]];
      made->uv.row(c) << point[0], point[1];
    }
    made->islands = 1;
    made->quality = uv::quality(*part_->surface, made->uv, execution_.workers());
    made->soft_length = cost / uv::kSeam;
    return std::make_shared<const Map>(part_, nullptr, std::move(made), "", execution_);
  }

  Candidate candidate(double bound, double cost, double work = 0) {
    return {work, [bound](const MapPointer&, Execution&) { return bound; },
            [this, cost](const MapPointer&, Execution&) {
              made_.push_back(cost);
              return cost < kInfinity ? map(cost) : nullptr;
            }};
  }

  double found(const std::vector<Candidate>& candidates) {
    const MapPointer best = least(candidates, nullptr, budget_, execution_);
    return best ? best->cost() : kInfinity;
  }

  PartPointer part_ = part_of_faces({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  Execution execution_{1};
  Budget budget_{0, 1e-3};
  std::vector<double> made_;
};

TEST_F(Least, WhatIsBoundToCostMoreIsNotMade) {
  EXPECT_NEAR(found({candidate(1, 3), candidate(2, 2.5), candidate(2.6, 2.7), candidate(0, 2.8)}), 2.5, 1e-12);
  EXPECT_EQ(made_, (std::vector<double>{3, 2.5, 2.8}));
}

TEST_F(Least, ThereMayBeNone) {
  EXPECT_EQ(found({candidate(kInfinity, 1), candidate(0, kInfinity)}), kInfinity);
  EXPECT_EQ(made_, std::vector<double>{kInfinity});
}

TEST_F(Least, WhatTakesTooLongIsMadeWhereThereIsNoOther) {
  Candidate longer = candidate(0, 1, 2 * kMost);
  EXPECT_NEAR(found({candidate(0, 3, 2 * kMost), longer}), 3, 1e-12);
  EXPECT_TRUE(budget_.was_short());
  longer.times = 3;
  EXPECT_NEAR(found({candidate(0, 3, 2 * kMost), longer}), 1, 1e-12);
}

TEST_F(Least, WhatIsRefusedIsLeftOut) {
  Candidate unbound = candidate(0, 2), refused = candidate(0, 1);
  unbound.bound = [](const MapPointer&, Execution&) -> double { throw TopologyError("no bound"); };
  refused.make = [](const MapPointer&, Execution&) -> MapPointer { throw SolverError("no map"); };
  EXPECT_NEAR(found({refused, candidate(0, 3), refused, unbound}), 2, 1e-12);
  refused.make = [](const MapPointer&, Execution&) -> MapPointer { throw Cancelled("it was stopped"); };
  EXPECT_THROW(found({refused}), Cancelled);
}

TEST_F(Least, ACandidateMayJudgeByMoreThanItsCost) {
  Candidate judge = candidate(0, 3), none = candidate(0, kInfinity);
  judge.judges = none.judges = true;
  EXPECT_NEAR(found({candidate(0, 2.5), judge, none}), 3, 1e-12);
}

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
