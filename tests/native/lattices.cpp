#include "lattices.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

namespace holomorph::linear {

IntegerMatrix random_integers(Eigen::Index rows, Eigen::Index columns, std::int64_t largest, unsigned seed) {
  std::mt19937_64 engine(seed);
  return IntegerMatrix::NullaryExpr(rows, columns, [&] {
    return static_cast<std::int64_t>(engine() % static_cast<std::uint64_t>(2 * largest + 1)) - largest;
  });
}

IntegerMatrix scrambled(IntegerMatrix basis, unsigned seed) {
  const Eigen::Index n = basis.cols();
  const IntegerMatrix lower = random_integers(n, n, 3, seed), upper = random_integers(n, n, 3, seed + 1);
  return (basis * lower.triangularView<Eigen::UnitLower>()).eval() * upper.triangularView<Eigen::UnitUpper>();
}

IntegerMatrix checkerboard_lattice(Eigen::Index n) {
  IntegerMatrix basis = IntegerMatrix::Identity(n, n);
  for (Eigen::Index j = 1; j < n; ++j) basis(j - 1, j) = -1;
  basis(0, 0) = basis(1, 0) = 1;
  return basis;
}

IntegerMatrix twice_e8() {
  IntegerMatrix basis = 2 * checkerboard_lattice(8);
  basis.col(7).setOnes();  // twice this vector is in the lattice of the others: it replaces one column of D_8
  return basis;
}

IntegerMatrix knapsack(Eigen::Index n, std::int64_t largest, unsigned seed) {
  IntegerMatrix basis(n + 1, n);
  basis << IntegerMatrix::Identity(n, n), random_integers(1, n, largest, seed);
  return basis;
}

IntegerMatrix modular_lattice(Eigen::Index n, std::int64_t q, unsigned seed) {
  const Eigen::Index half = n / 2;
  IntegerMatrix basis = IntegerMatrix::Identity(n, n);
  basis.topLeftCorner(half, half) *= q;
  basis.topRightCorner(half, n - half) = random_integers(half, n - half, q / 2, seed);
  return basis;
}

IntegerMatrix badly_scaled(Eigen::Index rows, Eigen::Index columns, int bits, unsigned seed) {
  IntegerMatrix basis = random_integers(rows, columns, (std::int64_t{1} << bits) - 1, seed);
  const int half_range = std::min(40, 61 - bits) / 2;
  const IntegerMatrix exponents = random_integers(1, columns, half_range, seed + 1);
  for (Eigen::Index j = 0; j < columns; ++j) basis.col(j) *= std::int64_t{1} << (half_range + exponents(0, j));
  return basis;
}

double mean_defect(const Eigen::MatrixXd& basis) {
  const Eigen::MatrixXd R = Eigen::HouseholderQR<Eigen::MatrixXd>(basis).matrixQR();
  const Eigen::ArrayXd ratio = basis.colwise().norm().transpose().array() / R.diagonal().array().abs();
  return std::exp(ratio.log().mean());
}

}  // namespace holomorph::linear
