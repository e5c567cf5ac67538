#include "turns/rounding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::turns {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using SparseComplex = Eigen::SparseMatrix<Complex, Eigen::RowMajor>;

constexpr double kLeastScale = 0.05;  // of e^u, below which triangles weigh no more
constexpr double kRegular = 1e-10;    // of the mean diagonal: vertices of triangles without area alone
constexpr int kSizes = 9, kAngles = 25;
constexpr Eigen::Index kColumns = 32;                   // solved for at once
constexpr double kSpread = 0.12;                        // of ln size, to either side
constexpr double kTurned = 6 * std::numbers::pi / 180;  // radians from level, to either side

// A side of a triangle: y(b) turned less y(a) turned, the weight, and what it is to be for f = 1.
struct Term {
  int a, b;
  Complex turn_a, turn_b, wanted;
  double weight;
};

// The offsets of a side's ends, one less the other, as complex numbers, for each z.
SparseComplex differences(const Net& net, const TurnedSpace& space) {
  std::vector<Eigen::Triplet<Complex>> entries;
  const auto add = [&](int row, int corner, double sign) {
    for (int i = 0; i < 2; ++i) {
      const Complex unit = i == 0 ? Complex(1) : space.lattice.second;
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(space.offset, 2 * corner + i); it; ++it)
        entries.emplace_back(row, static_cast<int>(it.col()), sign * it.value() * unit);
    }
  };
  for (int side = 0; side < net.side_count(); ++side) {
    add(side, Net::next(side), 1);
    add(side, side, -1);
  }
  SparseComplex result(net.side_count(), space.offset.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

Complex turned_by(const TurnLattice& lattice, int r) {
  const Turn& turn = lattice.power(r);
  return lattice.at(turn(0, 0), turn(1, 0));
}

NearestMap::NearestMap(const Net& net, const Frames& frames, const TurnedSpace& space)
    : unknown_(net.vertex_count(), -1) {
  int count = 0;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] >= 0 && !space.is_fixed[v]) unknown_[v] = count++;
  }
  const auto integers = space.offset.cols();
  const SparseComplex dq = differences(net, space);
  std::vector<Eigen::Triplet<double>> entries;
  double trace = 0;
  const auto add = [&](int row, int column, Complex value) {
    const double block[2][2] = {{value.real(), -value.imag()}, {value.imag(), value.real()}};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        if (2 * row + i >= 2 * column + j && block[i][j] != 0)
          entries.emplace_back(2 * row + i, 2 * column + j, block[i][j]);
      }
    }
  };
  // Real and imaginary parts, in turn, of P^H T and P^H Q: zero away from the cut.
  std::vector<Eigen::Triplet<double>> on_right;
  const auto add_right = [&](int row, Eigen::Index column, Complex value) {
    if (row < 0) return;
    on_right.emplace_back(2 * row, static_cast<int>(column), value.real());
    on_right.emplace_back(2 * row + 1, static_cast<int>(column), value.imag());
  };
  MatrixXcd QQ = MatrixXcd::Zero(integers, integers);
  VectorXcd QT = VectorXcd::Zero(integers);
  for (int side = 0; side < net.side_count(); ++side) {
    const int t = side / 3, from = net.tail[side], to = net.head[side], a = unknown_[from], b = unknown_[to];
    if (!(net.area[t] > 0)) continue;
    double u = 0;
    for (int i = 0; i < 3; ++i) u += frames.scale[net.tail[3 * t + i]] / 3;
    const double scale = std::exp(u), bounded = std::max(scale, kLeastScale);
    const double c = net.cotangent[side] / (bounded * bounded);
    const Complex wanted = scale * std::polar(1.0, -frames.angle[t]) * net.along[side];
    const Complex at_a = turned_by(space.lattice, space.corner_turn[side]);
    const Complex at_b = turned_by(space.lattice, space.corner_turn[Net::next(side)]);
    if (a >= 0) add(a, a, c), trace += c;
    if (b >= 0) add(b, b, c), trace += c;
    add_right(a, 0, -c * std::conj(at_a) * wanted);
    add_right(b, 0, c * std::conj(at_b) * wanted);
    if (a >= 0 && b >= 0 && a != b) {
      if (a > b)
        add(a, b, -c * std::conj(at_a) * at_b);
      else
        add(b, a, -c * std::conj(at_b) * at_a);
    }
    for (SparseComplex::InnerIterator it(dq, side); it; ++it) {
      add_right(a, 1 + it.col(), -c * std::conj(at_a) * it.value());
      add_right(b, 1 + it.col(), c * std::conj(at_b) * it.value());
      QT[it.col()] += c * std::conj(it.value()) * wanted;
      for (SparseComplex::InnerIterator other(dq, side); other; ++other)
        QQ(it.col(), other.col()) += c * std::conj(it.value()) * other.value();
    }
  }
  for (int i = 0; i < 2 * count; ++i) entries.emplace_back(i, i, kRegular * trace / std::max(count, 1));
  Eigen::SparseMatrix<double> lower(2 * count, 2 * count);
  lower.setFromTriplets(entries.begin(), entries.end());
  solving_->factor.compute(lower, {});
  rhs_.resize(2 * count, 1 + integers);
  rhs_.setFromTriplets(on_right.begin(), on_right.end());
  const MatrixXd y = solving_->factor.solve(rhs_.col(0));
  // The imaginary part of P^H y is the real part of P^H (-i y), of y turned by a quarter.
  VectorXd turned(2 * count);
  for (int i = 0; i < count; ++i) turned[2 * i] = y(2 * i + 1, 0), turned[2 * i + 1] = -y(2 * i, 0);
  const VectorXd real = rhs_.transpose() * y.col(0), imaginary = rhs_.transpose() * turned;
  g_ = QT - real.tail(integers) - Complex(0, 1) * imaginary.tail(integers);
  MatrixXd S = QQ.real();
  for (Eigen::Index first = 0; first < integers; first += kColumns) {
    const Eigen::Index some = std::min<Eigen::Index>(kColumns, integers - first);
    const MatrixXd x = solving_->factor.solve(MatrixXd(rhs_.middleCols(1 + first, some)));
    S.middleCols(first, some) -= (rhs_.transpose() * x).bottomRows(integers);
  }
  S = (0.5 * (S + S.transpose())).eval();
  if (integers > 0) {
    S.diagonal().array() += 1e-12 * S.trace() / static_cast<double>(integers);
    const linear::Cholesky<MatrixXd> root(S);
    if (!root.succeeded()) throw SolverError("the whole numbers of a turned map have no least energy");
    B_ = root.upper();
  }
}

std::vector<NearestMap::Rounded> NearestMap::round(Complex factor) const {
  if (B_.size() == 0) return {{0, factor, lattice::IntegerVector(0)}};
  const lattice::ReducedBasis reduced = lattice::reduce(B_);
  const linear::Cholesky<MatrixXd> normal(B_.transpose() * B_);
  std::vector<Rounded> found;
  for (int i = 0; i < kSizes; ++i) {
    const double size = std::exp(kSpread * (2.0 * i / (kSizes - 1) - 1));
    for (int j = 0; j < kAngles; ++j) {
      const Complex f = factor * std::polar(size, kTurned * (2.0 * j / (kAngles - 1) - 1));
      const VectorXd z0 = normal.solve(VectorXd((f * g_).real()));
      const lattice::IntegerVector z = lattice::nearest_plane(reduced, B_ * z0);
      const double error = (B_ * (z0 - z.cast<double>())).squaredNorm() / std::norm(f);
      const auto known = std::ranges::find_if(found, [&](const Rounded& one) { return one.z == z; });
      if (known == found.end())
        found.push_back({error, f, z});
      else if (error < known->error)
        *known = {error, f, z};
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Rounded& a, const Rounded& b) { return a.error < b.error; });
  return found;
}

VectorXcd NearestMap::functions(const Rounded& rounded) const {
  // The right side for another factor f = a + i b turns with it: a b0 + b (i b0).
  VectorXd b = rounded.factor.real() * rhs_.col(0);
  const VectorXd wanted = rhs_.col(0);
  for (Eigen::Index i = 0; i < b.size(); i += 2) {
    b[i] -= rounded.factor.imag() * wanted[i + 1];
    b[i + 1] += rounded.factor.imag() * wanted[i];
  }
  if (rounded.z.size() > 0) b -= rhs_.rightCols(rounded.z.size()) * rounded.z.cast<double>();
  const std::lock_guard lock(solving_->one_at_a_time);
  const MatrixXd x = solving_->factor.solve(b);
  VectorXcd y = VectorXcd::Zero(std::ssize(unknown_));
  for (std::size_t v = 0; v < unknown_.size(); ++v) {
    const Eigen::Index row = 2 * unknown_[v];
    if (row >= 0) y[static_cast<Eigen::Index>(v)] = Complex(x(row, 0), x(row + 1, 0));
  }
  return y;
}

Complex level_factor(const Net& net, const Frames& frames, int k, const std::vector<std::array<double, 3>>& points,
                     const Along& along) {
  const Level level = level_directions(net, points, along);
  Complex sum = 0;
  for (int t = 0; t < net.triangle_count(); ++t) {
    const Complex of_u = std::polar(1.0, frames.angle[t]);
    sum += net.area[t] * level.steepness[t] * std::pow(std::conj(level.direction[t]) * of_u, k);
  }
  return std::polar(1.0, std::abs(sum) > 0 ? std::arg(sum) / k : 0.0);
}

}  // namespace holomorph::turns
