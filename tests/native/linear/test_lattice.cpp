#include "linear/reduction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <string>

#include "base/errors.h"
#include "laplacians.h"
#include "lattices.h"

namespace holomorph::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

__extension__ using Wide = __int128;

constexpr double kDelta = 0.99;
// Slack of the certificates computed from the basis by Eigen's QR factorisation, relative to the diagonal of R.
constexpr double kSlack = 1e-9;
constexpr double kRounding = 1e-13;

struct Lattice {
  std::string name;
  IntegerMatrix integers;
  double unit = 1;  // a power of 2: the basis is integers * unit, exactly
  MatrixXd basis() const { return integers.cast<double>() * unit; }
};
void PrintTo(const Lattice& lattice, std::ostream* out) { *out << lattice.name; }

class EveryLattice : public testing::TestWithParam<Lattice> {};
INSTANTIATE_TEST_SUITE_P(, EveryLattice,
                         testing::Values(Lattice{"one_column", random_integers(3, 1, 9, 1)},
                                         Lattice{"hexagonal",
                                                 scrambled(IntegerMatrix{{1000000, 500000}, {0, 866025}}, 2),
                                                 std::ldexp(1, -20)},
                                         Lattice{"cubic", scrambled(IntegerMatrix::Identity(12, 12), 3)},
                                         Lattice{"checkerboard", scrambled(checkerboard_lattice(10), 4)},
                                         Lattice{"e8", scrambled(twice_e8(), 5), 0.5},
                                         Lattice{"random", random_integers(60, 60, 1000000, 6)},
                                         Lattice{"tall", random_integers(50, 30, 1000, 7)},
                                         Lattice{"knapsack", knapsack(40, 1000000000, 8), std::ldexp(1, -15)},
                                         Lattice{"modular", modular_lattice(60, 4001, 9)},
                                         Lattice{"badly_scaled", badly_scaled(33, 31, 10, 341), std::ldexp(1, -20)},
                                         Lattice{"beyond_doubles", badly_scaled(12, 12, 50, 12), std::ldexp(1, -50)}),
                         [](const auto& info) { return info.param.name; });

// By Gaussian elimination modulo a prime below 2^31.
std::int64_t determinant_modulo(IntegerMatrix A, std::int64_t prime) {
  const auto inverse = [&](std::int64_t a) {  // a^(p - 2), by Fermat
    std::int64_t power = 1;
    for (std::int64_t e = prime - 2; e > 0; e /= 2, a = a * a % prime) {
      if (e % 2 == 1) power = power * a % prime;
    }
    return power;
  };
  A = A.unaryExpr([&](std::int64_t a) { return (a % prime + prime) % prime; }).eval();
  std::int64_t determinant = 1;
  for (Index k = 0; k < A.cols(); ++k) {
    Index pivot = k;
    while (pivot < A.rows() && A(pivot, k) == 0) ++pivot;
    if (pivot == A.rows()) return 0;
    if (pivot != k) {
      A.row(pivot).swap(A.row(k));
      determinant = prime - determinant;
    }
    determinant = determinant * A(k, k) % prime;
    const std::int64_t inverted = inverse(A(k, k));
    for (Index i = k + 1; i < A.rows(); ++i) {
      const std::int64_t factor = A(i, k) * inverted % prime;
      for (Index j = k; j < A.cols(); ++j) A(i, j) = (A(i, j) + (prime - factor) * A(k, j)) % prime;
    }
  }
  return determinant;
}

// Rounded once.
MatrixXd exact_product(const IntegerMatrix& A, const IntegerMatrix& B) {
  MatrixXd product(A.rows(), B.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < B.cols(); ++j) {
      Wide sum = 0;
      for (Index k = 0; k < A.cols(); ++k) sum += static_cast<Wide>(A(i, k)) * B(k, j);
      product(i, j) = static_cast<double>(sum);
    }
  }
  return product;
}

TEST_P(EveryLattice, TheTransformIsUnimodular) {
  const IntegerMatrix T = reduce(GetParam().basis()).transform;
  for (const std::int64_t prime : {2147483647, 1000000007}) {
    const std::int64_t determinant = determinant_modulo(T, prime);
    EXPECT_TRUE(determinant == 1 || determinant == prime - 1) << determinant << " modulo " << prime;
  }
}

TEST_P(EveryLattice, TheBasisIsTheProductRoundedOnce) {
  const ReducedBasis reduced = reduce(GetParam().basis());
  const MatrixXd product = exact_product(GetParam().integers, reduced.transform) * GetParam().unit;
  EXPECT_TRUE(solver::same_bits(reduced.basis, product));
}

TEST_P(EveryLattice, TheBasisIsReduced) {
  const MatrixXd basis = reduce(GetParam().basis(), kDelta).basis;
  const MatrixXd R = Eigen::HouseholderQR<MatrixXd>(basis).matrixQR();
  for (Index k = 1; k < basis.cols(); ++k) {
    const double rounding = kRounding * basis.col(k).norm();
    for (Index j = 0; j < k; ++j) EXPECT_LE(std::abs(R(j, k)), (0.5 + kSlack) * std::abs(R(j, j)) + rounding);
    const double mu = R(k - 1, k) / R(k - 1, k - 1), next = R(k, k) / R(k - 1, k - 1);
    EXPECT_LE(kDelta - kSlack, mu * mu + next * next) << k;
  }
}

TEST_P(EveryLattice, TheFactorisationIsThatOfTheBasis) {
  const ReducedBasis reduced = reduce(GetParam().basis());
  const auto& [basis, transform, Q, R, steps, blocks] = reduced;
  const Index n = basis.cols();
  EXPECT_LE((Q.transpose() * Q - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_TRUE(R.isUpperTriangular(0));
  EXPECT_GT(R.diagonal().minCoeff(), 0);
  const VectorXd error = (basis - Q * R).colwise().norm();
  EXPECT_LE((error.array() / basis.colwise().norm().transpose().array()).maxCoeff(), kRounding);
}

TEST_P(EveryLattice, SameBitsTwice) {
  const ReducedBasis first = reduce(GetParam().basis()), second = reduce(GetParam().basis());
  EXPECT_EQ(first.transform, second.transform);
  EXPECT_TRUE(solver::same_bits(first.basis, second.basis));
  EXPECT_TRUE(solver::same_bits(first.Q, second.Q));
  EXPECT_TRUE(solver::same_bits(first.R, second.R));
}

TEST_P(EveryLattice, TheNearestPlaneIsWithinHalfTheDiagonal) {
  const MatrixXd B = GetParam().basis();
  const ReducedBasis reduced = reduce(B);
  const double size = reduced.basis.colwise().norm().maxCoeff();
  for (unsigned seed = 0; seed < 5; ++seed) {
    const VectorXd target = 100 * size * solver::random_values(B.rows(), 1, seed);
    const IntegerVector z = nearest_plane(reduced, target);
    const VectorXd point = exact_product(GetParam().integers, z) * GetParam().unit;
    const VectorXd y = (reduced.Q.transpose() * (target - point)).cwiseAbs();
    const VectorXd box = (0.5 + kSlack) * reduced.R.diagonal();
    EXPECT_LE((y - box).maxCoeff(), kRounding * target.norm());
  }
}

TEST_P(EveryLattice, NearAPointOfTheLatticeItIsFound) {
  const ReducedBasis reduced = reduce(GetParam().basis());
  const Index n = reduced.basis.cols();
  const IntegerMatrix c = random_integers(n, 1, 50, 11);
  const VectorXd noise = solver::random_values(reduced.basis.rows(), 1, 12).normalized();
  const VectorXd target =
      reduced.basis * c.cast<double>() + 0.49 * reduced.R.diagonal().minCoeff() * noise;  // R_jj / 2 in every direction
  EXPECT_EQ(nearest_plane(reduced, target), reduced.transform * c);
}

TEST_P(EveryLattice, OfPlanesTheNearestIsAtLeastAsNear) {
  const MatrixXd B = GetParam().basis();
  const ReducedBasis reduced = reduce(B);
  const double size = reduced.basis.colwise().norm().maxCoeff();
  for (unsigned seed = 0; seed < 5; ++seed) {
    const VectorXd target = 100 * size * solver::random_values(B.rows(), 1, seed);
    const auto distance = [&](const IntegerVector& z) {
      return (target - exact_product(GetParam().integers, z) * GetParam().unit).norm();
    };
    const double plane = distance(nearest_plane(reduced, target));
    for (const int kept : {1, 8, 64})
      EXPECT_LE(distance(nearest_of_planes(reduced, target, kept)), plane + kRounding * target.norm());
  }
}

// The points of the checkerboard lattice beside a deep hole: the plane misses the nearest one, all sums do not.
TEST(Lattice, ManySumsFindTheNearestPoint) {
  const MatrixXd B = scrambled(checkerboard_lattice(6), 7).cast<double>();
  const ReducedBasis reduced = reduce(B);
  int nearer = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const VectorXd target = 3 * solver::random_values(reduced.basis.rows(), 1, seed);
    const auto squared = [&](const IntegerVector& z) { return (target - B * z.cast<double>()).squaredNorm(); };
    const double found = squared(nearest_of_planes(reduced, target, 200)),
                 plane = squared(nearest_plane(reduced, target));
    // Rounding each coordinate, and the worst of them the other way if the sum is odd, is nearest (Conway & Sloane).
    VectorXd point = target.array().round();
    if (std::llround(point.sum()) % 2 != 0) {
      Index worst = 0;
      (target - point).cwiseAbs().maxCoeff(&worst);
      point[worst] += target[worst] > point[worst] ? 1 : -1;
    }
    EXPECT_NEAR(found, (target - point).squaredNorm(), 1e-9);
    nearer += found < plane - 1e-9 ? 1 : 0;
  }
  EXPECT_GT(nearer, 0);
}

// In general the first column is longer than the least vector, by at most (4 / 3)^((n - 1) / 2) as delta tends to 1.
TEST(Lattice, LeastVectorsOfKnownLattices) {
  EXPECT_EQ(reduce(scrambled(IntegerMatrix::Identity(12, 12), 3).cast<double>()).basis.col(0).squaredNorm(), 1);
  EXPECT_EQ(reduce(scrambled(checkerboard_lattice(10), 4).cast<double>()).basis.col(0).squaredNorm(), 2);
  EXPECT_EQ(reduce(scrambled(twice_e8(), 5).cast<double>()).basis.col(0).squaredNorm(), 8);
}

TEST(Lattice, ScalingByAPowerOfTwoScalesTheBasis) {
  const MatrixXd B = random_integers(30, 30, 1000, 20).cast<double>();
  const ReducedBasis one = reduce(B);
  for (const double scale : {std::ldexp(1, -40), std::ldexp(1, 40)}) {
    const ReducedBasis scaled = reduce(B * scale);
    EXPECT_EQ(scaled.transform, one.transform);
    EXPECT_TRUE(solver::same_bits(scaled.basis, one.basis * scale));
  }
}

TEST(Lattice, OfRankZero) {
  const ReducedBasis reduced = reduce(MatrixXd(3, 0));
  EXPECT_EQ(reduced.basis.rows(), 3);
  EXPECT_EQ(nearest_plane(reduced, VectorXd::Ones(3)).size(), 0);
}

TEST(Lattice, DependentColumnsAreRefused) {
  MatrixXd B = badly_scaled(20, 10, 10, 21).cast<double>();
  B.col(6) = 3 * B.col(2) - 0.7 * B.col(8) + 1e-3 * B.col(0);
  EXPECT_THROW(reduce(B), SolverError);
  B.col(6).setZero();
  EXPECT_THROW(reduce(B), SolverError);
  B.col(6)[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reduce(B), SolverError);
  EXPECT_THROW(reduce(random_integers(5, 6, 1000, 22).cast<double>()), SolverError);
}

TEST(Lattice, TheDependentColumnIsNamed) {
  MatrixXd B = MatrixXd::Identity(4, 4);
  B.col(2).setZero();
  try {
    reduce(B);
    FAIL() << "not refused";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("column 2 "), std::string::npos) << error.what();
  }
}

TEST(Lattice, IntegersBeyondDoublesAreRefused) {
  EXPECT_THROW(reduce(MatrixXd{{1e-9, 1e9}, {0, 1}}), Error);
  const ReducedBasis reduced = reduce(MatrixXd{{1e-9, 0}, {0, 1}});
  EXPECT_THROW(nearest_plane(reduced, VectorXd{{1e9, 0}}), Error);
}

TEST(Lattice, APointThatIsNotFiniteIsRefused) {
  const ReducedBasis reduced = reduce(MatrixXd::Identity(2, 2));
  for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(nearest_plane(reduced, VectorXd{{0, value}}), SolverError);
    EXPECT_THROW(nearest_of_planes(reduced, VectorXd{{0, value}}, 4), SolverError);
  }
}

TEST(IntegerKernel, IsWhatTheMatrixTakesToZero) {
  IntegerMatrix A(3, 5);
  A << 2, 4, 0, -6, 1, 0, 3, 9, 0, 6, 2, 7, 9, -6, 7;  // the last row is the sum of the others
  const IntegerMatrix kernel = integer_kernel(A);
  ASSERT_EQ(kernel.cols(), 3);
  EXPECT_TRUE((A * kernel).isZero());
  // All of it: the greatest common divisor of the minors is 1, so that no vector between is left out.
  std::int64_t divisor = 0;
  for (int i = 0; i < 5; ++i) {
    for (int j = i + 1; j < 5; ++j) {
      Eigen::Matrix3d minor;
      for (int row = 0, k = 0; row < 5; ++row) {
        if (row != i && row != j) minor.row(k++) = kernel.row(row).cast<double>();
      }
      divisor = std::gcd(divisor, std::llround(minor.determinant()));
    }
  }
  EXPECT_EQ(divisor, 1);
  EXPECT_EQ(integer_kernel(IntegerMatrix::Identity(3, 3)).cols(), 0);
  EXPECT_EQ(integer_kernel(IntegerMatrix::Zero(2, 3)).cols(), 3);
}

}  // namespace
}  // namespace holomorph::linear
