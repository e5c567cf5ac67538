#include "linear/blas.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <thread>
#include <vector>

extern "C" __attribute__((weak)) int omp_get_max_active_levels(void);

namespace holomorph::linear {
namespace {

using Eigen::MatrixXd;

// Whole numbers, of which this part is not 0: products and sums of these are exact in any order.
MatrixXd whole(Eigen::Index rows, Eigen::Index columns, double part, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> numbers(-9, 9);
  std::uniform_real_distribution<double> uniform(0, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(random) < part ? numbers(random) : 0; });
}

// Rows and columns, on both sides of kSmall, and the part that is not 0.
class Blas : public testing::TestWithParam<std::tuple<int, int, double>> {
 protected:
  int rows = std::get<0>(GetParam()), columns = std::get<1>(GetParam());
  MatrixXd A = whole(rows, columns, std::get<2>(GetParam()), 1);
};

TEST_P(Blas, ProductsOfWholeNumbersAreExact) {
  const MatrixXd B = whole(columns, 35, 0.9, 2), G = B.transpose() * B, T = whole(rows, 35, std::get<2>(GetParam()), 3);
  EXPECT_EQ(product(A, B), A * B);
  EXPECT_EQ(congruent(T, G), T * G * T.transpose());
  MatrixXd sum = MatrixXd::Ones(rows + 2, 37);
  add_product_transposed(A, B.transpose(), sum.block(1, 1, rows, 35));
  MatrixXd expected = MatrixXd::Ones(rows + 2, 37);
  expected.block(1, 1, rows, 35) += A * B;
  EXPECT_EQ(sum, expected);
}

TEST_P(Blas, ThinProductsOfWholeNumbersAreExact) {
  const MatrixXd tall = whole(1300, columns, 0.9, 2), X = whole(columns, 2, 1, 3), Y = whole(1300, 2, 1, 4);
  EXPECT_EQ(thin_product(tall, X), tall * X);
  EXPECT_EQ(thin_transposed_product(tall, Y), tall.transpose() * Y);
}

TEST_P(Blas, FactorsAndEigenvectorsGiveTheMatrixBack) {
  MatrixXd G = A * A.transpose() + 10 * MatrixXd::Identity(rows, rows), L = G, V = G, X = A;
  ASSERT_TRUE(factorise(L));
  solve_lower(L, X);
  solve_upper(L, X);
  EXPECT_LE((G * X - A).norm(), 1e-9 * A.norm());
  EXPECT_LE((G * solve(G, A) - A).norm(), 1e-9 * A.norm());
  Eigen::VectorXd values;
  ASSERT_TRUE(decompose(V, values));
  EXPECT_LT((V * values.asDiagonal() * V.transpose() - G).norm(), 1e-12 * G.norm());
  G(0, 0) = -1;
  EXPECT_FALSE(factorise(G));
}

TEST_P(Blas, ThreadsSideBySideFindTheSameBits) {
  const MatrixXd B = whole(columns, 64, 1, 2) / 7, alone = product(A / 3, B);
  std::vector<MatrixXd> found(3);
  std::vector<std::thread> threads;
  for (MatrixXd& each : found) threads.emplace_back([&] { each = product(A / 3, B); });
  for (std::thread& thread : threads) thread.join();
  for (const MatrixXd& each : found) EXPECT_EQ(each, alone);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Blas,
                         testing::Combine(testing::Values(5, 33, 120), testing::Values(7, 200),
                                          testing::Values(0.02, 1.0)));

TEST(OneBlasThread, LetsOpenMpStartNoThreadsMeanwhile) {
  if (!omp_get_max_active_levels) GTEST_SKIP() << "without OpenMP";
  const int before = omp_get_max_active_levels();
  {
    const OneBlasThread one;
    EXPECT_EQ(omp_get_max_active_levels(), 0);
    {
      const OneBlasThread within;
      EXPECT_EQ(omp_get_max_active_levels(), 0);
    }
    EXPECT_EQ(omp_get_max_active_levels(), 0);
  }
  EXPECT_EQ(omp_get_max_active_levels(), before);
}

}  // namespace
}  // namespace holomorph::linear
