#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.h"
#include "lattices.h"
#include "linear/reduction.h"

using namespace holomorph::linear;

namespace {

constexpr std::int64_t kSteps = 1'000'000;
constexpr double kRounding = 1e-9;

NearPoints around_origin(const IntegerMatrix& basis, double squared_radius) {
  const Eigen::MatrixXd B = basis.cast<double>();
  return near_points(reduce(B), Eigen::VectorXd::Zero(B.rows()), squared_radius + kRounding, kSteps);
}

}  // namespace

TEST(NearPoints, CountTheShortVectors) {
  EXPECT_EQ(around_origin(scrambled(twice_e8(), 1), 8).integers.size(), 240 + 1);
  for (const Eigen::Index n : {3, 4, 5})
    EXPECT_EQ(around_origin(scrambled(checkerboard_lattice(n), 2), 2).integers.size(), 2 * n * (n - 1) + 1);
}

TEST(NearPoints, AreThoseOfABox) {
  const Eigen::MatrixXd B = random_integers(4, 3, 5, 3).cast<double>() + 6 * Eigen::MatrixXd::Identity(4, 3);
  const Eigen::VectorXd target = B * Eigen::Vector3d(0.3, -0.6, 0.1) + Eigen::VectorXd::Constant(4, 0.2);
  constexpr double kRadius = 9;
  std::size_t expected = 0;
  for (int x = -9; x <= 9; ++x) {
    for (int y = -9; y <= 9; ++y) {
      for (int z = -9; z <= 9; ++z) expected += (target - B * Eigen::Vector3d(x, y, z)).norm() <= kRadius;
    }
  }
  const NearPoints found = near_points(reduce(B), target, kRadius * kRadius, kSteps);
  ASSERT_GT(expected, 3U);
  EXPECT_EQ(found.integers.size(), expected);
  for (const IntegerVector& z : found.integers) EXPECT_LE((target - B * z.cast<double>()).norm(), kRadius);
  EXPECT_TRUE(found.is_complete);
}

TEST(NearPoints, NoneWhereTheSpanIsFarAway) {
  const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(3, 2);
  const Eigen::Vector3d target(0, 0, 2);
  EXPECT_TRUE(near_points(reduce(B), target, 3.9, kSteps).integers.empty());
  EXPECT_EQ(near_points(reduce(B), target, 4.1, kSteps).integers.size(), 1U);
}

TEST(NearPoints, StopAtTheLimit) {
  const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(5, 5);
  const NearPoints found = near_points(reduce(B), Eigen::VectorXd::Zero(5), 100, 1000);
  EXPECT_FALSE(found.is_complete);
  EXPECT_LE(found.steps, 1001);
}

TEST(NearPoints, RefuseIntegersThatAreNotExact) {
  const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_THROW(near_points(reduce(B), Eigen::Vector2d(1e17, 0), 1, kSteps), holomorph::Error);
}
