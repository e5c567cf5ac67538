// The sanitizers of this build are on: each ends a process with a defect of its kind, and says what it found.
#include <gtest/gtest.h>

#include <climits>
#include <cstdlib>

#include "planted_defects.h"

namespace {

class PlantedDefects : public testing::Test {
 protected:
  // Each in a process begun anew: a copy of one with threads is not what a sanitizer expects.
  void SetUp() override { testing::GTEST_FLAG(death_test_style) = "threadsafe"; }
};

#ifdef HOLOMORPH_SANITIZE_ADDRESS
TEST_F(PlantedDefects, HeapOverflowIsFound) { EXPECT_DEATH(heap_overflow(10), "heap-buffer-overflow"); }

TEST_F(PlantedDefects, LeakIsFoundAtTheEnd) {
  EXPECT_EXIT((leak(), std::exit(0)), [](int status) { return status != 0; }, "LeakSanitizer: detected memory leaks");
}
#endif

#ifdef HOLOMORPH_SANITIZE_UNDEFINED
TEST_F(PlantedDefects, SignedOverflowIsFound) { EXPECT_DEATH(signed_overflow(INT_MAX), "signed integer overflow"); }
#endif

#ifdef HOLOMORPH_SANITIZE_THREAD
TEST_F(PlantedDefects, DataRaceIsFoundByTheEnd) {
  EXPECT_EXIT((data_race(), std::exit(0)), [](int status) { return status != 0; }, "data race");
}
#endif

TEST_F(PlantedDefects, WithoutADefectNothingIsFound) {
  EXPECT_EXIT((signed_overflow(1), std::exit(0)), testing::ExitedWithCode(0), "^$");
}

}  // namespace
