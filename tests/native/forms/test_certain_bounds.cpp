#include <gmpxx.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "forms/certain_bounds.h"

namespace holomorph::forms {
namespace {

using Eigen::MatrixXd;
Execution execution{1};
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

TEST_P(CertainBounds, LargeMatricesHaveTheSameBounds) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> uniform(-1, 1);
  const MatrixXd A = positive(40, GetParam() % 5, GetParam());
  MatrixXd T = MatrixXd::NullaryExpr(40, 40, [&] { return uniform(random); });
  if (GetParam() % 2 == 1) T = (T.array().abs() < 0.95).select(0, T);  // few numbers other than 0
  const Wide wide = T.cast<long double>();
  const Wide exact = wide * A.cast<long double>() * wide.transpose();
  const Wide above = above_congruent(T, A).cast<long double>() - exact;
  EXPECT_GT(least_eigenvalue(above), -1e-18 * above.norm());  // rows of 0 have no error
  EXPECT_LT(above.norm(), 1e-11 * exact.norm());
  const Wide below = A.cast<long double>().inverse() - below_inverse(A).cast<long double>();
  EXPECT_GT(least_eigenvalue(below), 0);
  EXPECT_LT(below.norm(), 1e-6 * A.cast<long double>().inverse().norm());
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
    const PeriodBounds bounds = period_bounds(exact + part * exact.trace() / 6 * G / G.trace(), execution);
    EXPECT_GT(least_eigenvalue((Y - bounds.lower).cast<long double>()), 0);
    EXPECT_GT(least_eigenvalue((bounds.upper - Y).cast<long double>()), 0);
    EXPECT_TRUE((bounds.real_lower.array() <= X.array()).all());
    EXPECT_TRUE((bounds.real_upper.array() >= X.array()).all());
    EXPECT_LT((bounds.real_upper - bounds.real_lower).norm(), 100 * std::sqrt(part) * exact.norm());
  }
}

// ---- in exact rationals ---------------------------------------------------------------------------------------------

constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
constexpr double kNear = 0.1;  // part of a bound that some true error is to exceed

// T G T^T of one row T.
mpq_class exact_energy(const MatrixXd& T, const MatrixXd& G) {
  mpq_class sum = 0;
  for (int i = 0; i < G.rows(); ++i) {
    for (int j = 0; j < G.cols(); ++j) sum += mpq_class(T(0, i)) * mpq_class(G(i, j)) * mpq_class(T(0, j));
  }
  return sum;
}

// By how much above_congruent is above, in units of rounding of the terms.
double units_above(const MatrixXd& T, const MatrixXd& G) {
  const double terms = (T.cwiseAbs() * G.cwiseAbs() * T.cwiseAbs().transpose()).value();
  return mpq_class((mpq_class(above_congruent(T, G).value()) - exact_energy(T, G)) / terms).get_d() / kUnit;
}

TEST(ExactCertainBounds, ProductsOfNumbers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(1, 2);
  double least = 1e9, most = 0;
  for (int k = 0; k < 100000; ++k) {
    const double units = units_above(MatrixXd{{uniform(random)}}, MatrixXd{{uniform(random)}});
    least = std::min(least, units), most = std::max(most, units);
  }
  EXPECT_GE(least, 0);
  EXPECT_LE(least, (1 - kNear) * (most + least) / 2);  // in the middle nothing is rounded
}

TEST(ExactCertainBounds, SumsInWhichTermsAreLost) {
  for (const int n : {2, 8, 32, 100}) {
    MatrixXd G = MatrixXd::Constant(n, n, 0.99 * kUnit);
    G.row(0).setOnes();
    G.col(0).setOnes();
    EXPECT_GE(units_above(MatrixXd::Ones(1, n), G), 0);
  }
}

TEST(ExactCertainBounds, InversesOfNumbers) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(1, 2);
  double least = 1e9, most = 0;
  for (int k = 0; k < 100000; ++k) {
    const MatrixXd A{{uniform(random)}};
    const double units = mpq_class(1 - mpq_class(below_inverse(A).value()) * mpq_class(A.value())).get_d() / kUnit;
    least = std::min(least, units), most = std::max(most, units);
  }
  EXPECT_GE(least, 0);
  EXPECT_LE(least, (1 - kNear) * (most + least) / 2);
}

TEST(ExactCertainBounds, ImaginaryPartsWithoutAnyOtherError) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    const MatrixXd G = positive(2, 1, seed);
    const PeriodBounds bounds = period_bounds(G, execution);
    const mpq_class a(G(0, 0)), b(G(0, 1)), c(G(1, 1));
    EXPECT_GE(mpq_class(bounds.upper.value()), mpq_class(a - b * b / c));
    EXPECT_LE(mpq_class(bounds.lower.value()) * c, 1);
  }
}

TEST(ExactCertainBounds, RealParts) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double most = 0;
  for (int k = 0; k < 10000; ++k) {
    const double x = uniform(random), y = 1.5 + uniform(random);
    const Eigen::Vector2d v(uniform(random), uniform(random));
    const MatrixXd exact{{y + x * x / y, -x / y}, {-x / y, 1 / y}};  // symplectic, of the period x + i y
    const PeriodBounds bounds = period_bounds(exact + 1e-4 * v * v.transpose(), execution);
    const double lower = bounds.real_lower.value(), upper = bounds.real_upper.value();
    most = std::max(most, std::abs(x - (lower + upper) / 2) / ((upper - lower) / 2));
  }
  EXPECT_LE(most, 1);
  EXPECT_GE(most, kNear);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CertainBounds, testing::Range(0U, 20U));

}  // namespace
}  // namespace holomorph::forms
