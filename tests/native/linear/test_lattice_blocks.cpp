#include "linear/blocks.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "lattices.h"

namespace holomorph::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRank = 3 * kBlock + 5;

struct Reduced {
  MatrixXd B, points;
  ReducedBasis basis;
};

Reduced reduced(int threads) {
  Execution execution(threads);
  Reduced result{random_integers(kRank + 20, kRank, 1000, 3).cast<double>(), MatrixXd::Random(kRank + 20, 2) * 1e5, {}};
  result.basis = reduce_by_blocks(result.B, result.points, execution);
  return result;
}

TEST(LatticeBlocks, HaveTheSameLattice) {
  const Reduced r = reduced(2);
  EXPECT_GT(r.basis.blocks, 1);
  const MatrixXd T = r.basis.transform.cast<double>();
  EXPECT_NEAR(std::abs(T.determinant()), 1, 1e-6);
  const MatrixXd BT = r.B * T;
  EXPECT_LT((BT.transpose() * BT - r.basis.R.transpose() * r.basis.R).norm(), 1e-9 * (BT.transpose() * BT).norm());
}

TEST(LatticeBlocks, AreReduced) {
  const Reduced r = reduced(2);
  Execution execution(1);
  for (Index begin = kBlock / 2; begin < kRank; begin += kBlock) {
    const Index size = std::min<Index>(kBlock, kRank - begin);
    for (Index k = begin + 1; k < begin + size; ++k)
      EXPECT_LE(std::abs(r.basis.R(k - 1, k)), 0.51 * r.basis.R(k - 1, k - 1)) << k;
  }
  // The product of the lengths is that of the lattice; the sum of squares fell.
  const MatrixXd before = r.B.householderQr().matrixQR().triangularView<Eigen::Upper>();
  EXPECT_LT(r.basis.R.diagonal().squaredNorm(), before.diagonal().squaredNorm());
}

TEST(LatticeBlocks, RoundToTheBox) {
  const Reduced r = reduced(2);
  for (Index i = 0; i < 2; ++i) {
    const IntegerVector z = nearest_plane(r.basis, r.points.col(i));
    const VectorXd y = r.points.col(i) - r.basis.R * (r.basis.transform.cast<double>().inverse() * z.cast<double>());
    EXPECT_TRUE((y.array().abs() <= 0.501 * r.basis.R.diagonal().array()).all());
  }
}

TEST(LatticeBlocks, DoNotDependOnThreads) {
  const Reduced one = reduced(1), four = reduced(4);
  EXPECT_EQ(one.basis.transform, four.basis.transform);
  EXPECT_EQ(one.basis.R, four.basis.R);
  EXPECT_EQ(one.basis.steps, four.basis.steps);
}

TEST(LatticeBlocks, CanBeCancelled) {
  int calls = 0;
  Execution execution(2, [&](double, const std::string&) { return ++calls < 1; });
  MatrixXd points(kRank, 0);
  const MatrixXd B = random_integers(kRank, kRank, 1000000, 3).cast<double>();
  EXPECT_THROW(reduce_by_blocks(B, points, execution), Cancelled);
  EXPECT_EQ(calls, 1);
}

// Another map is made of a surface whose tiling is refused so.
TEST(LatticeBlocks, RefuseIntegersBeyondDoubles) {
  Execution execution(1);
  MatrixXd B = MatrixXd::Identity(2 * kBlock, 2 * kBlock), points(2 * kBlock, 0);
  B.row(0).tail(2 * kBlock - 1).setConstant(1e20);
  EXPECT_THROW(reduce_by_blocks(B, points, execution), SolverError);
}

}  // namespace
}  // namespace holomorph::linear
