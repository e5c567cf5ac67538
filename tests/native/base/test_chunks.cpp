#include "base/workers.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace holomorph {
namespace {

constexpr int kRowCounts[] = {0, 1, kChunk - 1, kChunk, kChunk + 1, 10 * kChunk + 5};

class ChunksOf : public testing::TestWithParam<int> {
 protected:
  Workers workers_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, ChunksOf, testing::Values(1, 2, 4, 8));

TEST(Chunks, CoverAllRows) {
  EXPECT_EQ(chunk_count(0), 0);
  EXPECT_EQ(chunk_count(1), 1);
  EXPECT_EQ(chunk_count(kChunk), 1);
  EXPECT_EQ(chunk_count(kChunk + 1), 2);
}

TEST_P(ChunksOf, EveryRowIsVisitedOnce) {
  for (const int rows : kRowCounts) {
    std::vector<int> visits(rows, 0);
    for_rows(workers_, rows, [&](int i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(rows, 1));
  }
}

// Appending does not commute: the sum tells the order of all rows.
TEST_P(ChunksOf, SumsAreInTheOrderOfTheRows) {
  for (const int rows : kRowCounts) {
    std::string expected;
    for (int i = 0; i < rows; ++i) expected += std::to_string(i) + ",";
    const std::string sum =
        sum_over_rows(workers_, rows, std::string(), [](int i, std::string& sum) { sum += std::to_string(i) + ","; });
    EXPECT_EQ(sum, expected);
  }
}

TEST_P(ChunksOf, SumsHaveTheBitsOfOneThread) {
  const auto harmonic = [](Workers& workers) {
    return sum_over_rows(workers, 50 * kChunk + 7, 0.0, [](int i, double& sum) { sum += 1.0 / (i + 1); });
  };
  Workers one(1);
  const double expected = harmonic(one);
  for (int run = 0; run < 20; ++run) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(harmonic(workers_)), std::bit_cast<std::uint64_t>(expected));
  }
}

TEST_P(ChunksOf, TheFirstChunkThatThrowsIsHeardAndTheOthersAreDone) {
  constexpr int kChunks = 40;
  for (int run = 0; run < 20; ++run) {
    std::vector<int> done(kChunks, 0);
    std::string heard;
    try {
      run_throwing(workers_, kChunks, [&](int chunk) {
        if (chunk == 38 || chunk == 11 || chunk == 12) throw std::runtime_error(std::to_string(chunk));
        done[chunk] = 1;
      });
    } catch (const std::runtime_error& error) {
      heard = error.what();
    }
    EXPECT_EQ(heard, "11");
    std::vector<int> expected(kChunks, 1);
    expected[11] = expected[12] = expected[38] = 0;
    EXPECT_EQ(done, expected);
  }
}

TEST_P(ChunksOf, TasksMayAskForTheThread) {
  std::vector<int> done(GetParam(), 0);
  run_throwing(workers_, 100, [&](int thread, int) { ++done.at(thread); });
  int sum = 0;
  for (const int count : done) sum += count;
  EXPECT_EQ(sum, 100);
}

TEST_P(ChunksOf, FirstRowIsTheLowest) {
  for (const int rows : kRowCounts) {
    EXPECT_EQ(first_row(workers_, rows, [](int) { return false; }), rows);
    EXPECT_EQ(first_row(workers_, rows, [](int) { return true; }), 0);
    for (const int first : {0, 1, kChunk - 1, kChunk, 3 * kChunk + 17}) {
      const int found = first_row(workers_, rows, [&](int i) { return i >= first && (i - first) % 5 == 0; });
      EXPECT_EQ(found, std::min(first, rows));
    }
  }
}

TEST_P(ChunksOf, ATestThatThrowsIsHeard) {
  EXPECT_THROW(first_row(workers_, 5 * kChunk,
                         [](int i) {
                           if (i == 3 * kChunk) throw std::out_of_range("row");
                           return false;
                         }),
               std::out_of_range);
}

}  // namespace
}  // namespace holomorph
