#include "moduli/isometries.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lattice/near_points.h"
#include "moduli/quadratic_forms.h"

namespace holomorph::moduli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using lattice::IntegerVector;

// Relative error of energies that small dense products may add, and the bounds need not exclude.
constexpr double kRounding = 1e-9;
// What a reduction costs, in nodes of a search for near points, times the square of the rank.
constexpr std::int64_t kReduction = 10;
// Part of the steps that may be spent on a list of all vectors that are short enough for any row.
constexpr std::int64_t kListPart = 50;
// Vectors of such a list: all are looked through for each row.
constexpr std::size_t kMostListed = 20'000;

class Search {
 public:
  Search(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options, Execution& execution)
      : a_(reduced(a)), b_(reduced(b)), options_(options), steps_left_(options.steps), execution_(execution) {
    const double slack = options.slack + kRounding;
    // The slack is in logarithms of energies: it widens the bounds by a factor.
    upper_ = a_.lattice.upper * std::exp(slack);
    lower_ = a_.lattice.lower * std::exp(-slack);
    middle_ = (upper_ + lower_) / 2;
    root_ = lower_.llt().matrixU();
    spread_ = std::expm1(log_ratios(upper_, lower_).greatest) / 2;
    rows_.resize(size(), size());
    list_short_vectors();
  }

  Isometries run() {
    extend(0);
    return std::move(result_);
  }

 private:
  Index size() const { return middle_.rows(); }

  // Symmetric surfaces have few short vectors and many isometries: then rows are looked up. Where classes differ in
  // length by factors of thousands the list would not end, and each row has a search of its own.
  void list_short_vectors() {
    const double longest = b_.lattice.upper.diagonal().maxCoeff() * (1 + kRounding);
    const auto found =
        lattice::near_points(lattice::reduce(root_), VectorXd::Zero(size()), longest, options_.steps / kListPart);
    steps_left_ -= found.steps;
    if (!found.is_complete || found.integers.size() > kMostListed) return;
    short_.resize(static_cast<Index>(found.integers.size()), size());
    for (Index i = 0; i < short_.rows(); ++i) short_.row(i) = found.integers[i].cast<double>().transpose();
    short_lengths_ = (short_ * middle_).cwiseProduct(short_).rowwise().sum();
    energy_products_.resize(short_.rows(), size());
    wedge_products_.resize(short_.rows(), size());
  }

  void extend(Index k) {
    if (k == size()) return take();
    for (const IntegerVector& candidate : short_.rows() > 0 ? listed(k) : candidates(k)) {
      rows_.row(k) = candidate.transpose();
      if (short_.rows() > 0) {
        energy_products_.col(k) = short_ * (middle_ * candidate.cast<double>());
        wedge_products_.col(k) = -(short_ * (a_.lattice.pairing * candidate).cast<double>());
      }
      if (has_pairing(k) && is_possible(k + 1)) extend(k + 1);
      // Out of steps: what is found so far may be not all.
      if (!result_.is_complete) return;
    }
  }

  // The short vectors with the products that row k needs.
  std::vector<IntegerVector> listed(Index k) {
    execution_.report(1 - static_cast<double>(steps_left_) / static_cast<double>(options_.steps));
    std::vector<IntegerVector> result;
    const auto goal = [&](Index j) { return (b_.lattice.upper(j, k) + b_.lattice.lower(j, k)) / 2; };
    std::vector<double> tolerances;
    for (Index j = 0; j <= k; ++j) tolerances.push_back(tolerance(j, k));
    const auto fits = [&](Index i) {
      if (std::abs(short_lengths_[i] - goal(k)) > tolerances[k]) return false;
      for (Index j = 0; j < k; ++j) {
        const auto wedge = static_cast<double>(options_.sign * b_.lattice.pairing(j, k));
        if (wedge_products_(i, j) != wedge || std::abs(energy_products_(i, j) - goal(j)) > tolerances[j]) return false;
      }
      return true;
    };
    for (Index i = 0; i < short_.rows(); ++i) {
      if (fits(i)) result.push_back(short_.row(i).cast<std::int64_t>().transpose());
    }
    steps_left_ -= short_.rows();
    result_.is_complete &= steps_left_ > 0;
    return result;
  }

  // Each condition on row k is a number of absolute value at most 1, or 0 for a wedge product, so that the sum of their
  // squares is bounded: a ball in the lattice that all of them embed.
  std::vector<IntegerVector> candidates(Index k) {
    execution_.report(1 - static_cast<double>(steps_left_) / static_cast<double>(options_.steps));
    const Index n = size();
    const double longest = b_.lattice.upper(k, k), bound = (1 + kRounding) * (1 + static_cast<double>(k));
    const MatrixXd rows = rows_.topRows(k).cast<double>();
    MatrixXd conditions(n + 2 * k, n);
    VectorXd target = VectorXd::Zero(n + 2 * k);
    conditions.topRows(n) = root_ / std::sqrt(longest);
    const double exact = 2 * std::sqrt(bound);  // a wrong wedge product alone leaves the ball
    for (Index j = 0; j < k; ++j) {
      const double tolerance = this->tolerance(j, k);
      conditions.row(n + 2 * j) = rows.row(j) * middle_ / tolerance;
      target[n + 2 * j] = (b_.lattice.upper(j, k) + b_.lattice.lower(j, k)) / 2 / tolerance;
      conditions.row(n + 2 * j + 1) = exact * rows.row(j) * a_.lattice.pairing.cast<double>();
      target[n + 2 * j + 1] = exact * options_.sign * static_cast<double>(b_.lattice.pairing(j, k));
    }
    auto near = lattice::near_points(lattice::reduce(conditions), target, bound, steps_left_);
    steps_left_ -= near.steps + kReduction * n * n;
    result_.is_complete &= near.is_complete;
    return std::move(near.integers);
  }

  // By how much a product of rows may differ from that of b: |X_jk - M_jk|^2 <= D_jj D_kk for M - D <= X <= M + D.
  double tolerance(Index j, Index k) const {
    const MatrixXd &low = b_.lattice.lower, &high = b_.lattice.upper;
    const auto width = [&](Index i) { return std::max(0.0, high(i, i) - low(i, i)); };
    return std::sqrt(width(j) * width(k)) / 2 + (spread_ + kRounding) * std::sqrt(high(j, j) * high(k, k));
  }

  bool has_pairing(Index k) const {
    const auto products = (rows_.topRows(k) * a_.lattice.pairing * rows_.row(k).transpose()).eval();
    return products == options_.sign * b_.lattice.pairing.col(k).head(k);
  }

  // Whether the bounds of the first k rows overlap.
  bool is_possible(Index k) const {
    const MatrixXd rows = rows_.topRows(k).cast<double>();
    const auto above = [k](const MatrixXd& greater, const MatrixXd& less) {
      const MatrixXd difference = (1 + kRounding) * greater - less.topLeftCorner(k, k);
      return Eigen::LDLT<MatrixXd>(difference).isPositive();
    };
    const MatrixXd most = rows * upper_ * rows.transpose(), least = rows * lower_ * rows.transpose();
    return above(most, b_.lattice.lower) && above(b_.lattice.upper.topLeftCorner(k, k), least);
  }

  void take() {
    const MatrixXd R = rows_.cast<double>();
    if (std::lround(std::abs(R.determinant())) != 1) return;  // a degenerate pairing allows others
    const auto moved = [&R](const MatrixXd& form) -> MatrixXd { return R * form * R.transpose(); };
    const auto ratio = log_ratios(moved(a_.lattice.projected), b_.lattice.projected);
    const double excess = std::max(-log_ratios(moved(a_.lattice.upper), b_.lattice.lower).least,
                                   -log_ratios(b_.lattice.upper, moved(a_.lattice.lower)).least);
    const IntegerMatrix matrix = checked_product(checked_product(b_.inverse, rows_), a_.basis);
    result_.found.push_back({matrix, std::max(-ratio.least, ratio.greatest), excess});
  }

  ReducedLattice a_, b_;
  SearchOptions options_;
  std::int64_t steps_left_;
  Execution& execution_;
  MatrixXd upper_, lower_, middle_, root_;  // matrices of a, with the slack
  double spread_ = 0;                       // half-width of the bounds of a, relative to the lower one
  IntegerMatrix rows_;
  MatrixXd short_;  // rows: all vectors as short as the longest row may be; none where the list did not end
  VectorXd short_lengths_;
  MatrixXd energy_products_, wedge_products_;  // of the short vectors with each row, row j on the left of the wedge
  Isometries result_;
};

}  // namespace

Isometries isometries(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options,
                      Execution& execution) {
  return Search(a, b, options, execution).run();
}

}  // namespace holomorph::moduli
