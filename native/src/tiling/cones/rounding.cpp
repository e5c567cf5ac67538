#include "tiling/cones/rounding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::tiling {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using SparseComplex = Eigen::SparseMatrix<Complex, Eigen::RowMajor>;

constexpr double kLeastScale = 0.05;      // of e^u, below which triangles weigh no more
constexpr double kRegularMatrix = 1e-10;  // of the mean diagonal: vertices of triangles without area alone
constexpr int kSizes = 9, kAngles = 25;
constexpr int kSearched = 10, kSums = 32;  // targets for which nearer whole numbers are searched, partial sums for each
constexpr Eigen::Index kColumns = 16;      // solved for at once
constexpr double kSpreadOfRest = 0.06;     // of ln size, to either side
constexpr double kOtherSize = 1;           // price of (ln size)^2: larger sizes alone would round better
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

NearestMap::NearestMap(const Net& net, const Frames& frames, const TurnedSpace& space, bool turns, Execution& execution)
    : unknowns_(space.unknowns), turns_(turns), area_(net.whole_area) {
  const int count = unknowns_.count;
  const auto integers = space.offset.cols();
  const SparseComplex dq = differences(net, space);
  std::vector<Eigen::Triplet<double>> entries;
  // P^T T and P^T Q: zero away from the cut.
  std::vector<Eigen::Triplet<double>> on_right;
  const auto add_right = [&](int v, Eigen::Index column, Complex value) {
    const double parts[2] = {value.real(), value.imag()};
    for (int i = 0; i < 2; ++i) {
      const int p = 2 * v + i;
      if (unknowns_.number[p] >= 0)
        on_right.emplace_back(unknowns_.number[p], static_cast<int>(column), unknowns_.sign[p] * parts[i]);
    }
  };
  MatrixXcd QQ = MatrixXcd::Zero(integers, integers);
  std::vector<const std::vector<double>*> targets{&frames.angle};
  if (!frames.level.empty()) targets.push_back(&frames.level);
  const Eigen::Index wanted_columns = 2 * std::ssize(targets);
  MatrixXd QT = MatrixXd::Zero(integers, wanted_columns);
  double trace = 0;
  for (int side = 0; side < net.side_count(); ++side) {
    const int t = side / 3, a = net.tail[side], b = net.head[side];
    if (!(net.area[t] > 0)) continue;
    double u = 0;
    for (int i = 0; i < 3; ++i) u += frames.scale[net.tail[3 * t + i]] / 3;
    const double scale = std::exp(u), bounded = std::max(scale, kLeastScale);
    const double c = net.cotangent[side] / (bounded * bounded);
    const Complex at_a = turned_by(space.lattice, space.corner_turn[side]);
    const Complex at_b = turned_by(space.lattice, space.corner_turn[Net::next(side)]);
    unknowns_.add_difference(a, b, c, std::conj(at_a) * at_b, entries);
    trace += 2 * c;
    const auto add_both = [&](Eigen::Index column, Complex value) {
      add_right(a, column, -c * std::conj(at_a) * value);
      add_right(b, column, c * std::conj(at_b) * value);
    };
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(2 * i);
      const Complex wanted = scale * std::polar(1.0, -(*targets[i])[t]) * net.along[side];
      add_both(column, wanted);
      add_both(column + 1, Complex(0, 1) * wanted);
      for (SparseComplex::InnerIterator it(dq, side); it; ++it) {
        const Complex product = c * std::conj(it.value()) * wanted;
        QT(it.col(), column) += product.real();
        QT(it.col(), column + 1) -= product.imag();
      }
    }
    for (SparseComplex::InnerIterator it(dq, side); it; ++it) {
      add_both(wanted_columns + it.col(), it.value());
      for (SparseComplex::InnerIterator other(dq, side); other; ++other)
        QQ(it.col(), other.col()) += c * std::conj(it.value()) * other.value();
    }
  }
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, kRegularMatrix * trace / std::max(count, 1));
  Eigen::SparseMatrix<double> lower(count, count);
  lower.setFromTriplets(entries.begin(), entries.end());
  execution.report(1);
  solving_->factor.compute(lower, {});
  rhs_.resize(count, wanted_columns + integers);
  rhs_.setFromTriplets(on_right.begin(), on_right.end());
  const MatrixXd y = solving_->factor.solve(MatrixXd(rhs_.leftCols(wanted_columns)));
  g_ = QT - (rhs_.transpose() * y).bottomRows(integers);
  MatrixXd S = QQ.real();
  for (Eigen::Index first = 0; first < integers; first += kColumns) {
    execution.report(1);
    const Eigen::Index some = std::min<Eigen::Index>(kColumns, integers - first);
    const MatrixXd x = solving_->factor.solve(MatrixXd(rhs_.middleCols(wanted_columns + first, some)));
    S.middleCols(first, some) -= (rhs_.transpose() * x).bottomRows(integers);
  }
  S = (0.5 * (S + S.transpose())).eval();
  if (integers > 0) {
    // Where lines are whole, moving the map by the lattice changes nothing.
    S.diagonal().array() += (turns ? 1e-12 : 1e-9) * S.trace() / static_cast<double>(integers);
    const linear::Cholesky<MatrixXd> root(S);
    if (!root.succeeded()) throw SolverError("the whole numbers of a turned map have no least energy");
    B_ = root.upper();
  }
}

std::vector<NearestMap::Rounded> NearestMap::round(Complex factor) const {
  if (B_.size() == 0) return {{0, factor, linear::IntegerVector(0)}};
  std::vector<std::vector<Rounded>> found;
  std::size_t most = 0;
  for (Eigen::Index first = 0; first < g_.cols(); first += 2) {
    found.push_back(rounded(factor, g_.middleCols(first, 2)));
    most = std::max(most, found.back().size());
  }
  std::vector<Rounded> result;
  for (std::size_t i = 0; i < most; ++i) {
    for (std::size_t target = 0; target < found.size(); ++target) {
      if (i >= found[target].size()) continue;
      result.push_back(found[target][i]);
      result.back().is_level = target == 1;
    }
  }
  return result;
}

std::vector<NearestMap::Rounded> NearestMap::rounded(Complex factor, const MatrixXd& g) const {
  const linear::ReducedBasis reduced = linear::reduce(B_);
  const linear::Cholesky<MatrixXd> normal(B_.transpose() * B_);
  std::vector<Rounded> found;
  const auto add = [&](Complex f, const auto& nearest) {
    const VectorXd z0 = normal.solve(VectorXd(g * Eigen::Vector2d(f.real(), f.imag())));
    const linear::IntegerVector z = nearest(B_ * z0);
    const double ln_size = std::log(std::abs(f) / std::abs(factor));
    const double error =
        (B_ * (z0 - z.cast<double>())).squaredNorm() / (std::norm(f) * area_) + kOtherSize * ln_size * ln_size;
    const auto known = std::ranges::find_if(found, [&](const Rounded& one) { return one.z == z; });
    if (known == found.end())
      found.push_back({error, f, z});
    else if (error < known->error)
      *known = {error, f, z};
  };
  const int angles = turns_ ? kAngles : 1;
  for (int i = 0; i < kSizes; ++i) {
    const double size = std::exp(kSpreadOfRest * (2.0 * i / (kSizes - 1) - 1));
    for (int j = 0; j < angles; ++j) {
      const double turned = turns_ ? kTurned * (2.0 * j / (kAngles - 1) - 1) : 0;
      add(factor * std::polar(size, turned),
          [&](const VectorXd& target) { return linear::nearest_plane(reduced, target); });
    }
  }
  const auto sort = [&] {
    std::stable_sort(found.begin(), found.end(), [](const Rounded& a, const Rounded& b) { return a.error < b.error; });
  };
  sort();
  // Along lines the size alone is free: the nearest plane finds what fits them exactly.
  const int searched = turns_ ? std::min<int>(kSearched, static_cast<int>(found.size())) : 0;
  for (int i = 0; i < searched; ++i)
    add(found[i].factor, [&](const VectorXd& target) { return linear::nearest_of_planes(reduced, target, kSums); });
  sort();
  return found;
}

VectorXcd NearestMap::functions(const Rounded& rounded, bool is_level) const {
  VectorXd b = rhs_.middleCols(is_level ? 2 : 0, 2) * Eigen::Vector2d(rounded.factor.real(), rounded.factor.imag());
  if (rounded.z.size() > 0) b -= rhs_.rightCols(rounded.z.size()) * rounded.z.cast<double>();
  const std::lock_guard lock(solving_->one_at_a_time);
  const uv::Function y = unknowns_.spread(solving_->factor.solve(b).col(0));
  return Eigen::Map<const VectorXcd>(y.data(), std::ssize(y));
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

}  // namespace holomorph::tiling
