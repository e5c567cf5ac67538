#include "moduli/equivalence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "base/constants.h"
#include "base/errors.h"
#include "forms/certain_bounds.h"
#include "linear/dense.h"
#include "linear/reduction.h"

namespace holomorph::moduli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using linear::IntegerVector;

constexpr double kLargestInteger = 9007199254740992;  // 2^53

// Exact: the entries of a unimodular inverse are integers, and the product is checked.
IntegerMatrix unimodular_inverse(const IntegerMatrix& A) {
  const MatrixXd inverse = linear::inverse(MatrixXd(A.cast<double>()));
  if (!(inverse.cwiseAbs().maxCoeff() < kLargestInteger)) throw Error("the lattice needs integers beyond 2^53");
  const IntegerMatrix rounded = inverse.array().round().matrix().cast<std::int64_t>();
  if (checked_product(A, rounded) != IntegerMatrix::Identity(A.rows(), A.cols()))
    throw Error("the basis of the lattice of periods is too badly conditioned");
  return rounded;
}

MatrixXd in_basis(const IntegerMatrix& basis, const MatrixXd& form) {
  const MatrixXd T = basis.cast<double>();
  return forms::symmetric(T * form * T.transpose());
}

// Relative error of energies that small dense products may add, and the bounds need not exclude.
constexpr double kRounding = 1e-9;
// What a reduction costs, in nodes of a search for near points, times the square of the rank.
constexpr std::int64_t kReduction = 10;
// Part of the steps that may be spent on a list of all vectors that are short enough for any row.
constexpr std::int64_t kListPart = 50;
// Vectors that are looked through in the time of a step.
constexpr std::int64_t kLookedUp = 4;
// Vectors of such a list: all are looked through for each row.
constexpr std::size_t kMostListed = 20'000;

class LatticeSearch {
 public:
  LatticeSearch(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options, Execution& execution)
      : options_(options),
        steps_left_(options.steps),
        execution_(execution),
        tick_([this] { report(); }),
        a_(reduced(a, tick_)),
        b_(reduced(b, tick_)) {
    const double slack = options.slack + kRounding;
    // The slack is in logarithms of energies: it widens the bounds by a factor.
    upper_ = a_.lattice.upper * std::exp(slack);
    lower_ = a_.lattice.lower * std::exp(-slack);
    middle_ = (upper_ + lower_) / 2;
    root_ = linear::Cholesky(lower_).upper();
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
  void report() { execution_.report(1 - static_cast<double>(steps_left_) / static_cast<double>(options_.steps)); }

  // Symmetric surfaces have few short vectors and many isometries: then rows are looked up. Where classes differ in
  // length by factors of thousands the list would not end, and each row has a search of its own.
  void list_short_vectors() {
    const double longest = b_.lattice.upper.diagonal().maxCoeff() * (1 + kRounding);
    const auto found = linear::near_points(linear::reduce(root_, linear::kDelta, tick_), VectorXd::Zero(size()),
                                           longest, options_.steps / kListPart, tick_);
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
    Execution::count(1);
    report();
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
    steps_left_ -= short_.rows() / kLookedUp + 1;
    result_.is_complete &= steps_left_ > 0;
    return result;
  }

  // Each condition on row k is a number of absolute value at most 1, or 0 for a wedge product, so that the sum of their
  // squares is bounded: a ball in the lattice that all of them embed.
  std::vector<IntegerVector> candidates(Index k) {
    Execution::count(1);
    report();
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
    auto near =
        linear::near_points(linear::reduce(conditions, linear::kDelta, tick_), target, bound, steps_left_, tick_);
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
      return linear::is_positive(difference);
    };
    const MatrixXd most = rows * upper_ * rows.transpose(), least = rows * lower_ * rows.transpose();
    return above(most, b_.lattice.lower) && above(b_.lattice.upper.topLeftCorner(k, k), least);
  }

  void take() {
    const MatrixXd R = rows_.cast<double>();
    if (std::lround(std::abs(linear::determinant(R))) != 1) return;  // a degenerate pairing allows others
    const auto moved = [&R](const MatrixXd& form) -> MatrixXd { return R * form * R.transpose(); };
    const auto ratio = log_ratios(moved(a_.lattice.projected), b_.lattice.projected);
    const double excess = std::max(-log_ratios(moved(a_.lattice.upper), b_.lattice.lower).least,
                                   -log_ratios(b_.lattice.upper, moved(a_.lattice.lower)).least);
    const IntegerMatrix matrix = checked_product(checked_product(b_.inverse, rows_), a_.basis);
    result_.found.push_back({matrix, std::max(-ratio.least, ratio.greatest), excess});
  }

  SearchOptions options_;
  std::int64_t steps_left_;
  Execution& execution_;
  std::function<void()> tick_;
  ReducedLattice a_, b_;
  MatrixXd upper_, lower_, middle_, root_;  // matrices of a, with the slack
  double spread_ = 0;                       // half-width of the bounds of a, relative to the lower one
  IntegerMatrix rows_;
  MatrixXd short_;  // rows: all vectors as short as the longest row may be; none where the list did not end
  VectorXd short_lengths_;
  MatrixXd energy_products_, wedge_products_;  // of the short vectors with each row, row j on the left of the wedge
  Isometries result_;
};

// Residuals of less are rounding, whatever the bounds.
constexpr double kLeastTolerance = 1e-9;
// Residuals are allowed to grow by this factor from search to search: the nearest isometries are found among few.
constexpr double kFirstPart = 1e-4, kGrowth = 100;
// By this factor a mirror image has to be nearer than the surface itself: many surfaces are nearly their mirror images.
constexpr double kNearer = 4;
// The margin is looked for in doubling steps, from one to the other: dilatations up to 4.
constexpr double kFirstMargin = 1e-3, kLargestMargin = 2 * std::numbers::ln2;
// Part of the steps that each of these searches may take: the verdict is known without them.
constexpr std::int64_t kMarginPart = 100;

const Isometry* nearest(const Isometries& isometries) {
  const auto less = [](const Isometry& x, const Isometry& y) { return x.residual < y.residual; };
  const auto found = std::min_element(isometries.found.begin(), isometries.found.end(), less);
  return found == isometries.found.end() ? nullptr : &*found;
}

class Judge {
 public:
  Judge(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
        Execution& execution)
      : a_(a), b_(b), allowed_(allowed), needed_(needed), steps_(steps), execution_(execution) {}

  Comparison run() {
    const double of_a = radius(a_), of_b = radius(b_);
    execution_.stage("integer matrices", 0, 0.3);
    const bool agree = look_near(std::max({kLeastTolerance, allowed_, needed_}));
    execution_.stage("integer matrices", 0.3, 0.6);
    if (!agree) take_nearest(a_, b_, allowed_, result_.is_complete);
    const double found = result_.isometry ? result_.isometry->residual : kInfinity;
    result_.tolerance = found + of_a + of_b;
    execution_.stage("margin", 0.6, 1);
    if (!result_.isometry && result_.is_complete) exclude();
    execution_.finish();
    return result_;
  }

 private:
  // Whether projected periods agree to `needed`; then that is the verdict.
  bool look_near(double needed) {
    const PeriodLattice a = projected_lattice(a_), b = projected_lattice(b_);
    bool is_complete = true;
    for (double part = kFirstPart; is_complete && part <= 1; part *= kGrowth) {
      if (!take_nearest(a, b, std::max(kLeastTolerance, part * needed), is_complete)) continue;
      result_.verdict = result_.sign > 0 ? Verdict::indistinguishable : Verdict::mirror_image;
      result_.margin = needed - held(result_.isometry).residual;
      return true;
    }
    return false;
  }

  bool take_nearest(const PeriodLattice& a, const PeriodLattice& b, double slack, bool& is_complete) {
    const Isometries same = isometries(a, b, {1, slack, steps_}, execution_);
    const Isometries mirrored = isometries(a, b, {-1, slack, steps_}, execution_);
    is_complete = same.is_complete && mirrored.is_complete;
    const Isometry *first = nearest(same), *second = nearest(mirrored);
    if (first == nullptr && second == nullptr) return false;
    const bool is_mirrored =
        first == nullptr ||
        (second != nullptr && kNearer * std::max(kLeastTolerance, second->residual) < first->residual);
    result_.isometry = is_mirrored ? *second : *first;
    result_.sign = is_mirrored ? -1 : 1;
    return true;
  }

  // The margin is certain: all isometries up to some slack are found, the last of which has the least excess.
  void exclude() {
    result_.verdict = Verdict::not_equivalent;
    result_.margin = allowed_;
    for (double slack = allowed_ + kFirstMargin;; slack = std::min(2 * slack, kLargestMargin)) {
      double least = slack;
      for (const int sign : {1, -1}) {
        const auto isometries = moduli::isometries(a_, b_, {sign, slack, steps_ / kMarginPart}, execution_);
        if (!isometries.is_complete) return;
        for (const Isometry& isometry : isometries.found) least = std::min(least, isometry.excess);
      }
      result_.margin = least;
      if (least < slack || slack >= kLargestMargin) return;
    }
  }

  const PeriodLattice &a_, &b_;
  double allowed_, needed_;
  std::int64_t steps_;
  Execution& execution_;
  Comparison result_;
};

}  // namespace

LogRatios log_ratios(const MatrixXd& A, const MatrixXd& B) {
  const linear::Cholesky root(B);
  if (!root.succeeded())
    throw SolverError("the energies of " + std::to_string(B.rows()) + " classes are not positive definite");
  // The eigenvalues of L^-1 A L^-T, B = L L^T, are the stationary values of x A x / x B x.
  const MatrixXd both = root.solve_lower(root.solve_lower(A).transpose());
  const Eigen::VectorXd values = linear::eigenvalues((both + both.transpose()) / 2);
  const auto log = [](double x) { return x > 0 ? std::log(x) : -kInfinity; };
  return {log(values.minCoeff()), log(values.maxCoeff())};
}

IntegerMatrix checked_product(const IntegerMatrix& A, const IntegerMatrix& B) {
  const MatrixXd most = A.cast<double>().cwiseAbs() * B.cast<double>().cwiseAbs();
  if (most.size() > 0 && !(most.maxCoeff() < kLargestInteger)) throw Error("the lattice needs integers beyond 2^53");
  return A * B;
}

IntegerMatrix short_basis(const MatrixXd& form, const std::function<void()>& tick) {
  // U^T U is the form, so that the columns of U span a lattice with these lengths and angles.
  const MatrixXd root = linear::Cholesky(form).upper();
  const auto reduced = linear::reduce(root, linear::kDelta, tick);
  const Eigen::VectorXd length = reduced.basis.colwise().norm();
  std::vector<Index> order(length.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return length[i] < length[j]; });
  return reduced.transform(Eigen::all, order).transpose();
}

PeriodLattice closed_lattice(const MatrixXd& G, const topology::IntegerMatrix& W) {
  const auto star = forms::projected_star(G, G, W.cast<double>());
  return {star.lower, G, star.natural_gram, W};
}

PeriodLattice bounded_lattice(const MatrixXd& G_N, const MatrixXd& G_D, const topology::IntegerMatrix& W, int genus) {
  const Index handles = 2 * genus;
  const MatrixXd real = W.cast<double>();
  IntegerMatrix pairing = IntegerMatrix::Zero(W.rows(), W.cols());
  pairing.topLeftCorner(handles, handles) = W.topLeftCorner(handles, handles);
  const MatrixXd lower = forms::symmetric(real.transpose() * forms::inverse(G_N) * real);
  return {lower, G_D, forms::projected_star(G_N, G_D, real).dirichlet_gram, pairing};
}

ReducedLattice reduced(const PeriodLattice& given, const std::function<void()>& tick) {
  const IntegerMatrix basis = short_basis(given.projected, tick);
  return {{in_basis(basis, given.lower), in_basis(basis, given.upper), in_basis(basis, given.projected),
           checked_product(checked_product(basis, given.pairing), basis.transpose())},
          basis,
          unimodular_inverse(basis)};
}

PeriodLattice projected_lattice(const PeriodLattice& lattice) {
  return {lattice.projected, lattice.projected, lattice.projected, lattice.pairing};
}

double radius(const PeriodLattice& lattice) {
  const auto above = log_ratios(lattice.upper, lattice.projected), below = log_ratios(lattice.projected, lattice.lower);
  return std::max({0.0, above.greatest, below.greatest});
}

Isometries isometries(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options,
                      Execution& execution) {
  return LatticeSearch(a, b, options, execution).run();
}

Comparison compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
                   Execution& execution) {
  return Judge(a, b, allowed, needed, steps, execution).run();
}

}  // namespace holomorph::moduli
