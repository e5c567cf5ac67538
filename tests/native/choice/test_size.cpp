#include "choice/size.h"

#include <gtest/gtest.h>

namespace holomorph::choice {
namespace {

TEST(BestWindow, IsAroundTheWantedDensityWithoutParts) {
  const Window window = best_window({});
  EXPECT_EQ(window.low, window_around().low);
  EXPECT_EQ(window.high, window_around().high);
  EXPECT_DOUBLE_EQ(window.low * window.high, 1);
}

TEST(BestWindow, HoldsTheWantedDensityAndMostByWeight) {
  std::vector<Sizes> parts{{{0.93}, 1.0}, {{0.92, 1.2}, 1.0}, {{1.06}, 1.5}, {{1.5}, 9.0}};
  const Window low = best_window(parts);
  EXPECT_LE(low.low, 0.92);
  EXPECT_TRUE(low.holds(1));
  EXPECT_DOUBLE_EQ(low.high, low.low * kLikeSize);
  EXPECT_FALSE(low.holds(1.06));
  parts[2].weight = 2.5;
  const Window high = best_window(parts);
  EXPECT_TRUE(high.holds(1.06));
  EXPECT_TRUE(high.holds(1));
}

TEST(BestWindow, IsTheMostMiddleOneOfEquals) {
  const Window window = best_window({{{0.99}, 1.0}, {{1.01}, 1.0}});
  EXPECT_EQ(window.low, window_around().low);
}

}  // namespace
}  // namespace holomorph::choice
