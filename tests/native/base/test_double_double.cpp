#include <gtest/gtest.h>

#include <cmath>

#include "base/double_double.h"

namespace holomorph {
namespace {

// Relative, a few units in the last place of 106 bits.
constexpr double kRounding = 1e-31;

double error(const DoubleDouble& a, const DoubleDouble& b) { return std::abs((a - b).value()); }

TEST(DoubleDouble, SumsAndProductsOfDoublesAreExact) {
  const double half = std::ldexp(1, -30);
  for (const double small : {std::ldexp(1, -80), -std::ldexp(1, -80)}) {
    for (const DoubleDouble& sum : {exact_sum(1, small), exact_sum(small, 1)}) {
      EXPECT_EQ(sum.high, 1.0);
      EXPECT_EQ(sum.low, small);
    }
  }
  const DoubleDouble product = exact_product(1 + half, 1 - half);  // 1 - 2^-60
  EXPECT_EQ(product.high, 1.0);
  EXPECT_EQ(product.low, -half * half);
}

TEST(DoubleDouble, CancellationKeepsTwiceTheDigits) {
  const DoubleDouble big = exact_sum(1e16, 1.0 / 3), difference = big - DoubleDouble{1e16};
  EXPECT_EQ(difference.value(), 1.0 / 3);
}

TEST(DoubleDouble, QuotientsAndRootsUndoProductsAndSquares) {
  const DoubleDouble three{3}, third = DoubleDouble{1} / three, root = sqrt(DoubleDouble{2});
  EXPECT_NE(third.low, 0.0);
  EXPECT_LE(error(third * three, {1}), kRounding);
  EXPECT_LE(error(root * root, {2}), 2 * kRounding);
  EXPECT_LE(error(sqrt(third * third), third), kRounding);
  EXPECT_EQ(sqrt(DoubleDouble{0}).value(), 0.0);
}

}  // namespace
}  // namespace holomorph
