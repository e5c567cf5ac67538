// What evening added to a map is forgiven, and nothing that was there.
#include "uv/quality.h"

#include <gtest/gtest.h>

namespace holomorph::uv {
namespace {

double unseen(double after, double before, double evenness) {
  Quality quality, earlier;
  quality.mean_angle = after;
  earlier.mean_angle = before;
  set_evened_from(quality, earlier, evenness);
  return quality.unseen_angle;
}

TEST(Quality, ShearThatEveningAddedIsForgivenUpToALimit) {
  EXPECT_EQ(unseen(1.3, 1.3, 1), 0);
  EXPECT_EQ(unseen(1.2, 1.3, 1), 0);  // evening took shear away
  EXPECT_DOUBLE_EQ(unseen(1.4, 1.3, 1), 1.4 - 1.3);
  EXPECT_EQ(unseen(2.0, 1.3, 1), kUnseen);
  EXPECT_EQ(unseen(2.0, 1.3, 0.5), kUnseen / 2);
}

}  // namespace
}  // namespace holomorph::uv
