#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "conformal/certain_bounds.h"

namespace holomorph::conformal {
namespace {

using Eigen::MatrixXd;
using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

double least_eigenvalue(const Wide& A) {
  return Eigen::SelfAdjointEigenSolver<Wide>(A, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

// Positive definite, its condition about 10^digits.
MatrixXd positive(int n, double digits, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  MatrixXd A = MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  for (int i = 0; i < n; ++i) A.row(i) *= std::pow(10.0, -digits * i / (2.0 * n));
  return A * A.transpose();
}

class CertainBounds : public testing::TestWithParam<unsigned> {
 protected:
  MatrixXd G = positive(6, GetParam() % 7, GetParam());
};

TEST_P(CertainBounds, CongruentMatricesAreNotAbove) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> uniform(-1, 1);
  const MatrixXd T = MatrixXd::NullaryExpr(3, 6, [&] { return uniform(random); });
  const Wide exact = T.cast<long double>() * G.cast<long double>() * T.cast<long double>().transpose();
  const MatrixXd above = above_congruent(T, G);
  EXPECT_GT(least_eigenvalue(above.cast<long double>() - exact), 0);
  EXPECT_LT((above.cast<long double>() - exact).norm(), 1e-12 * exact.norm());
}

TEST_P(CertainBounds, InversesAreNotBelow) {
  const Wide exact = G.cast<long double>().inverse();
  const MatrixXd below = below_inverse(G);
  EXPECT_GT(least_eigenvalue(exact - below.cast<long double>()), 0);
  EXPECT_LT((exact - below.cast<long double>()).norm(), 1e-6 * exact.norm());
}

TEST_P(CertainBounds, PeriodsHoldThoseOfEverySmallerGramMatrix) {
  // G_exact is symplectic and below G: its own bounds meet.
  const MatrixXd Y = positive(3, 1, GetParam() + 50), Yi = Y.inverse();
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd X = MatrixXd::NullaryExpr(3, 3, [&] { return uniform(random); });
  X = ((X + X.transpose()) / 2).eval();
  MatrixXd exact(6, 6);
  exact << Y + X * Yi * X, -X * Yi, -Yi * X, Yi;
  for (const double part : {1e-9, 1e-4, 1e-1}) {
    const PeriodBounds bounds = period_bounds(exact + part * exact.trace() / 6 * G / G.trace());
    EXPECT_GT(least_eigenvalue((Y - bounds.lower).cast<long double>()), 0);
    EXPECT_GT(least_eigenvalue((bounds.upper - Y).cast<long double>()), 0);
    EXPECT_TRUE((bounds.real_lower.array() <= X.array()).all());
    EXPECT_TRUE((bounds.real_upper.array() >= X.array()).all());
    EXPECT_LT((bounds.real_upper - bounds.real_lower).norm(), 100 * std::sqrt(part) * exact.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CertainBounds, testing::Range(0U, 20U));

}  // namespace
}  // namespace holomorph::conformal
