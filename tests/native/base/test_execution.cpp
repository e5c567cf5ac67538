#include "base/execution.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace holomorph {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kInterval(20);

// An execution that keeps what it reports.
class ExecutionTest : public testing::Test {
 protected:
  using Report = std::pair<double, std::string>;

  // Lets the interval go by, so that the next report is heard.
  static void pause() { std::this_thread::sleep_for(kInterval + std::chrono::milliseconds(1)); }

  std::vector<Report> reports_;
  bool go_on_ = true;
  Execution execution_{1, [this](double fraction, const std::string& stage) {
                         reports_.emplace_back(fraction, stage);
                         return go_on_;
                       }};
};

TEST_F(ExecutionTest, StagesAreReportedAsTheyBegin) {
  execution_.stage("first", 0.0, 0.25);
  execution_.stage("second", 0.25, 1.0);
  execution_.finish();
  EXPECT_EQ(reports_, (std::vector<Report>{{0.0, "first"}, {0.25, "second"}, {1.0, "second"}}));
}

TEST_F(ExecutionTest, ReportsAreOfTheStageAndThePart) {
  execution_.stage("work", 0.25, 0.75);
  pause();
  execution_.report(0.25);
  EXPECT_EQ(reports_.back().first, 0.375);
  execution_.part(0.5, 1.0);
  pause();
  execution_.report(0.5);
  EXPECT_EQ(reports_.back().first, 0.625);
  execution_.stage("next", 0.75, 1.0);  // the part belongs to it no longer
  pause();
  execution_.report(0.5);
  EXPECT_EQ(reports_.back(), Report(0.875, "next"));
}

TEST_F(ExecutionTest, StagesWithinAreOfTheStageOrPart) {
  execution_.stage("outer", 0.0, 0.5);
  execution_.part(0.5, 1.0);
  {
    const Execution::Within within(execution_);
    execution_.stage("inner", 0.5, 1.0);
    execution_.finish();
  }
  pause();
  execution_.report(1.0);
  execution_.stage("next", 0.5, 1.0);
  execution_.finish();
  EXPECT_EQ(reports_,
            (std::vector<Report>{
                {0.0, "outer"}, {0.375, "inner"}, {0.5, "inner"}, {0.5, "outer"}, {0.5, "next"}, {1.0, "next"}}));
}

TEST_F(ExecutionTest, FractionsNeverFallNorPassOne) {
  execution_.stage("late", 0.5, 1.0);
  execution_.stage("early", 0.25, 0.5);
  pause();
  execution_.report(0.5);
  pause();
  execution_.report(7.0);
  execution_.stage("beyond", 1.5, 2.0);
  std::vector<double> fractions;
  for (const Report& report : reports_) fractions.push_back(report.first);
  EXPECT_EQ(fractions, (std::vector<double>{0.5, 0.5, 0.5, 1.0, 1.0}));
}

TEST_F(ExecutionTest, ReportsAreAtLeastAnIntervalApart) {
  // From before the report that was heard to within the next one: longer than between the two on the inside.
  Clock::time_point before, heard, within;
  int calls = 0;
  Execution execution(1, [&](double, const std::string&) {
    within = Clock::now();
    return ++calls > 0;
  });
  heard = Clock::now();
  execution.stage("work", 0, 1);
  for (int known = calls; calls < 5;) {
    before = Clock::now();
    execution.report(0.5);
    if (calls == known) continue;
    EXPECT_EQ(calls, ++known);
    EXPECT_GE(within - heard, kInterval);
    heard = before;
  }
}

TEST_F(ExecutionTest, StepsReportEvery4096th) {
  execution_.stage("work", 0.0, 1.0);
  pause();
  for (std::size_t i = 1; i < 4096; ++i) execution_.step(i, 8192);
  EXPECT_EQ(reports_.size(), 1U);
  execution_.step(4096, 8192, 0.5, 1.0);
  EXPECT_EQ(reports_.back(), Report(0.75, "work"));
}

TEST_F(ExecutionTest, FalseCancelsAndNamesTheStage) {
  execution_.stage("first", 0.0, 0.5);
  go_on_ = false;
  const auto cancelled_in = [](const auto& call) {
    try {
      call();
    } catch (const Cancelled& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(cancelled_in([&] { execution_.stage("second", 0.5, 1.0); }), "cancelled during second");
  pause();
  EXPECT_EQ(cancelled_in([&] { execution_.report(0.5); }), "cancelled during second");
  EXPECT_EQ(cancelled_in([&] { execution_.finish(); }), "cancelled during second");
}

TEST_F(ExecutionTest, SecondsOfAStageBegunTwiceAreSummed) {
  const std::chrono::milliseconds work(3);
  for (const char* name : {"first", "second", "first"}) {
    execution_.stage(name, 0.0, 1.0);
    std::this_thread::sleep_for(work);
  }
  execution_.finish();
  const auto& seconds = execution_.seconds();
  ASSERT_EQ(seconds.size(), 2U);
  EXPECT_EQ(seconds[0].first, "first");
  EXPECT_EQ(seconds[1].first, "second");
  EXPECT_GE(seconds[0].second, 2 * std::chrono::duration<double>(work).count());
  EXPECT_GE(seconds[1].second, std::chrono::duration<double>(work).count());
}

TEST_F(ExecutionTest, WithoutACallbackOnlySecondsAreKept) {
  Execution execution(3);
  EXPECT_EQ(execution.threads(), 3);
  execution.stage("work", 0.0, 1.0);
  pause();
  execution.report(0.5);
  execution.finish();
  ASSERT_EQ(execution.seconds().size(), 1U);
  EXPECT_EQ(execution.seconds()[0].first, "work");
}

}  // namespace
}  // namespace holomorph
