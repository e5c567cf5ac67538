#include "linear/reduction.h"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/double_double.h"
#include "base/errors.h"

namespace holomorph::linear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Columns of numbers in twice the working precision.

struct DoubleDoubleColumns {
  Eigen::MatrixXd high, low;

  /// Does column(k) -= factor * column(j), for a factor that is exact. Error: some 1e-32 of the larger term.
  void subtract(Eigen::Index k, double factor, Eigen::Index j) {
    const auto [f, g] = halves(factor);
    double *h = high.col(k).data(), *l = low.col(k).data();
    const double *a = high.col(j).data(), *b = low.col(j).data();
    for (Eigen::Index i = 0; i < high.rows(); ++i) {
      const auto [u, v] = halves(a[i]);
      const double product = factor * a[i], product_error = ((f * u - product) + f * v + g * u) + g * v;
      const double sum = h[i] - product, taken = h[i] - sum;
      const double sum_error = (h[i] - (sum + taken)) + (taken - product);
      const double rest = l[i] + (sum_error - product_error - factor * b[i]);
      h[i] = sum + rest;
      l[i] = rest - (h[i] - sum);
    }
  }

  void swap(Eigen::Index k, Eigen::Index j) {
    high.col(k).swap(high.col(j));
    low.col(k).swap(low.col(j));
  }
};

constexpr double kRounding = std::numeric_limits<double>::epsilon();
// Error of Q R that is tolerated until the end, relative to the length of a column: far above rounding, far below
// kSizeReduction.
constexpr double kDrift = 1e-12;
// |R_jk| <= (1/2 + this) R_jj is asked for, not 1/2: coefficients of exactly 1/2, frequent in lattices of integers,
// are left alone however they round.
constexpr double kSizeReduction = 1e-9;

constexpr double kLargestInteger = 9007199254740992;  // 2^53: up to here doubles count without gaps

[[noreturn]] void refuse_integers() { throw SolverError("the lattice needs integers beyond 2^53"); }

// Babai's rounding, from the last coordinate to the first: integral x that bring y - R x into the box |y_j| <= R_jj
// / 2. y becomes that difference; `noise` is its rounding error, below which nothing is done.
VectorXd round_off(const Eigen::Ref<const MatrixXd>& R, VectorXd& y, double noise) {
  VectorXd x = VectorXd::Zero(y.size());
  for (Index j = y.size() - 1; j >= 0; --j) {
    if (std::abs(y[j]) <= (0.5 + kSizeReduction) * R(j, j) + noise) continue;
    x[j] = std::round(y[j] / R(j, j));
    y.head(j + 1) -= x[j] * R.col(j).head(j + 1);
  }
  return x;
}

// A column that is nearer to the span of others than this, relative to its length, is within the rounding errors of
// the reduction; further away, every R_kk that `append` computes is positive.
double dependence(Index columns) { return 4 * columns * kRounding; }

void check_independence(const MatrixXd& B) {
  if (B.cols() == 0) return;
  if (!B.allFinite()) throw SolverError("the basis of the lattice has entries that are not finite");
  MatrixXd unit = B;
  for (auto column : unit.colwise()) column.stableNormalize();
  Eigen::ColPivHouseholderQR<MatrixXd> factor(unit);
  factor.setThreshold(dependence(B.cols()));
  if (factor.rank() == B.cols()) return;
  throw SolverError("column " + std::to_string(factor.colsPermutation().indices()[factor.rank()]) +
                    " of the lattice's basis depends linearly on the others");
}

// The columns are in double-double, so that no exchange or multiple loses digits that a short vector needs. Q and R of
// the first `known_` columns follow every step, by Givens rotations.
class Reduction {
 public:
  Reduction(const MatrixXd& B, double delta, const std::function<void()>& tick)
      : delta_(delta), tick_(tick), n_(B.cols()) {
    std::vector<Index> order(n_);  // ascending by length: far fewer exchanges
    std::iota(order.begin(), order.end(), 0);
    const VectorXd length = B.colwise().norm();
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return length[i] < length[j]; });
    columns_ = {B(Eigen::all, order), MatrixXd::Zero(B.rows(), n_)};
    transform_ = MatrixXd::Identity(n_, n_)(Eigen::all, order);
    Q_.resize(B.rows(), n_);
    R_ = MatrixXd::Zero(n_, n_);
  }

  // Repeated with a new factorisation until it confirms the last one.
  ReducedBasis run() {
    constexpr int kMostSweeps = 100;
    for (int sweeps = 0; sweep(); ++sweeps) {
      if (sweeps == kMostSweeps)
        throw SolverError("the reduction of a lattice of rank " + std::to_string(n_) + " stalls");
    }
    return {columns_.high, transform_.cast<std::int64_t>(), Q_, R_, steps_};
  }

 private:
  // One reduction from the first column on. Returns whether it changed the basis.
  bool sweep() {
    bool changed = false;
    factorise(0);
    for (Index k = 0; k < n_; ++steps_) {
      if (tick_) tick_();
      if (k == known_) project(k);
      changed |= size_reduce(k);
      if (k == known_) append(k);
      if (k == 0 || delta_ * R_(k - 1, k - 1) * R_(k - 1, k - 1) <= R_.col(k).segment(k - 1, 2).squaredNorm()) {
        ++k;
      } else {
        exchange(k--);
        changed = true;
      }
    }
    return changed;
  }

  void project(Index k) { R_.col(k).head(k).noalias() = Q_.leftCols(k).transpose() * columns_.high.col(k); }

  // The multiples are not exact where they are large, hence the repetition with new coefficients.
  bool size_reduce(Index k) {
    for (bool changed = false;; changed = true) {
      VectorXd y = R_.col(k).head(k);
      const VectorXd x = round_off(R_.topLeftCorner(k, k), y, noise(k));
      if ((x.array() == 0).all()) return changed;
      for (Index j = 0; j < k; ++j) {
        if (x[j] != 0) subtract(k, x[j], j);
      }
      project(k);
      if (k < known_ && drift(k) > kDrift * columns_.high.col(k).norm()) factorise(k + 1);
    }
  }

  // Error of the coefficients of column k: its own rounding, and the drift of the columns that are subtracted.
  double noise(Index k) const {
    const double longest = k == 0 ? 0 : R_.diagonal().head(k).maxCoeff();
    return Q_.rows() * kRounding * columns_.high.col(k).norm() + expected_drift_ * longest;
  }

  double drift(Index k) const { return (columns_.high.col(k) - Q_.leftCols(k + 1) * R_.col(k).head(k + 1)).norm(); }

  // Q and R anew, of this many columns.
  void factorise(Index columns) {
    expected_drift_ = 0;
    for (known_ = 0; known_ < columns;) {
      project(known_);
      append(known_);
    }
  }

  void subtract(Index k, double factor, Index j) {
    columns_.subtract(k, factor, j);
    transform_.col(k) -= factor * transform_.col(j);
    if (!(std::abs(factor) <= kLargestInteger && transform_.col(k).cwiseAbs().maxCoeff() <= kLargestInteger)) {
      refuse_integers();
    }
  }

  // Gram-Schmidt, twice: then q is orthogonal to rounding (Giraud et al. 2005, doi:10.1007/s00211-005-0615-4).
  void append(Index k) {
    const auto Q = Q_.leftCols(k);
    VectorXd q = columns_.high.col(k) - Q * R_.col(k).head(k);
    const VectorXd correction = Q.transpose() * q;
    q -= Q * correction;
    R_.col(k).head(k) += correction;
    R_(k, k) = q.norm();
    Q_.col(k) = q / R_(k, k);
    ++known_;
  }

  // Exchanges columns k - 1 and k. The rotation is followed by a reflection: the diagonal stays positive.
  void exchange(Index k) {
    columns_.swap(k - 1, k);
    transform_.col(k - 1).swap(transform_.col(k));
    R_.col(k - 1).head(k + 1).swap(R_.col(k).head(k + 1));
    const double length = std::hypot(R_(k - 1, k - 1), R_(k, k - 1));
    const double c = R_(k - 1, k - 1) / length, s = R_(k, k - 1) / length;
    const auto rotate = [c, s](double& upper, double& lower) {
      const double before = upper;
      upper = c * before + s * lower;
      lower = s * before - c * lower;
    };
    R_(k - 1, k - 1) = length;
    R_(k, k - 1) = 0;
    expected_drift_ = kDrift;
    for (Index j = k; j < known_; ++j) rotate(R_(k - 1, j), R_(k, j));
    for (Index i = 0; i < Q_.rows(); ++i) rotate(Q_(i, k - 1), Q_(i, k));
  }

  double delta_,
      expected_drift_ = 0;  // the error of Q R that must be expected: none from a factorisation to the next exchange
  const std::function<void()>& tick_;
  Index n_, known_ = 0;
  std::int64_t steps_ = 0;
  DoubleDoubleColumns columns_;
  MatrixXd transform_;  // integral
  MatrixXd Q_, R_;
};

// c such that basis * c is near the target.
VectorXd nearest_coefficients(const ReducedBasis& reduced, const VectorXd& target) {
  VectorXd c = VectorXd::Zero(reduced.R.cols()), residual = target;
  for (;;) {
    if (!residual.allFinite()) throw SolverError("the point to be rounded to the lattice is not finite");
    VectorXd y = reduced.Q.transpose() * residual;
    const VectorXd x = round_off(reduced.R, y, residual.size() * kRounding * residual.norm());
    if ((x.array() == 0).all()) return c;
    c += x;
    residual -= reduced.basis * x;
  }
}

// For the basis that was reduced.
IntegerVector original_integers(const ReducedBasis& reduced, const VectorXd& c) {
  const MatrixXd transform = reduced.transform.cast<double>();
  if (!((transform.cwiseAbs() * c.cwiseAbs()).array() <= kLargestInteger).all()) refuse_integers();
  return (transform * c).cast<std::int64_t>();
}

constexpr std::int64_t kNodes = 2048;  // between two calls of the tick: less than 10 ms

// Coordinates of R z near y are chosen from the last to the first, as R is upper triangular.
class Enumeration {
 public:
  Enumeration(const ReducedBasis& reduced, VectorXd y, std::int64_t most_steps, const std::function<void()>& tick)
      : R_(reduced.R), transform_(reduced.transform), y_(std::move(y)), most_steps_(most_steps), tick_(tick) {
    z_ = VectorXd::Zero(R_.cols());
  }

  NearPoints run(double left) {
    visit(R_.cols() - 1, left);
    return std::move(result_);
  }

 private:
  // `left`: what the coordinates after k have left of the squared radius.
  void visit(Index k, double left) {
    if (k < 0) return take();
    const Index after = R_.cols() - k - 1;
    const double centre = (y_[k] - R_.row(k).tail(after).dot(z_.tail(after))) / R_(k, k);
    const double radius = std::sqrt(left) / R_(k, k), last = std::floor(centre + radius);
    if (!(std::abs(centre) + radius <= kLargestInteger)) refuse_integers();
    for (double z = std::ceil(centre - radius); z <= last && result_.is_complete; ++z) {
      if (++result_.steps > most_steps_) {
        result_.is_complete = false;
        return;
      }
      if (tick_ && result_.steps % kNodes == 0) tick_();
      z_[k] = z;
      const double distance = (z - centre) * R_(k, k);
      visit(k - 1, std::max(0.0, left - distance * distance));
    }
  }

  void take() {
    const IntegerVector z = z_.cast<std::int64_t>();
    result_.integers.push_back(transform_ * z);
  }

  const Eigen::MatrixXd& R_;
  const IntegerMatrix& transform_;
  VectorXd y_, z_;
  std::int64_t most_steps_;
  const std::function<void()>& tick_;
  NearPoints result_;
};

}  // namespace

NearPoints near_points(const ReducedBasis& reduced, const VectorXd& target, double squared_radius,
                       std::int64_t most_steps, const std::function<void()>& tick) {
  const VectorXd y = reduced.Q.transpose() * target;
  // The distance from the span of the lattice is there whatever the point is.
  const double left = squared_radius - (target - reduced.Q * y).squaredNorm();
  if (!(left >= 0)) return {};
  return Enumeration(reduced, y, most_steps, tick).run(left);
}

ReducedBasis reduce(const MatrixXd& B, double delta, const std::function<void()>& tick) {
  assert(delta > 0.25 && delta < 1);
  check_independence(B);
  return Reduction(B, delta, tick).run();
}

IntegerVector nearest_plane(const ReducedBasis& reduced, const VectorXd& target) {
  return original_integers(reduced, nearest_coefficients(reduced, target));
}

IntegerVector nearest_of_planes(const ReducedBasis& reduced, const VectorXd& target, int kept) {
  struct Sum {
    double squared;
    VectorXd left;
    IntegerVector z;
  };
  struct Next {
    double squared;
    std::size_t sum;
    std::int64_t z;
  };
  const auto n = reduced.R.cols();
  // From the nearest plane on, where numbers are small.
  const VectorXd plane = nearest_coefficients(reduced, target);
  const VectorXd from_plane = reduced.Q.transpose() * (target - reduced.basis * plane);
  std::vector<Sum> sums{{0, from_plane, IntegerVector::Zero(n)}}, longer;
  for (Eigen::Index k = n; k-- > 0;) {
    std::vector<Next> all;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double at = sums[i].left[k] / reduced.R(k, k);
      const auto near = static_cast<std::int64_t>(std::llround(at));
      const int side = at > static_cast<double>(near) ? 1 : -1;
      for (const std::int64_t z : {near, near + side, near - side}) {
        const double off = (at - static_cast<double>(z)) * reduced.R(k, k);
        all.push_back({sums[i].squared + off * off, i, z});
      }
    }
    std::ranges::stable_sort(all, {}, &Next::squared);
    all.resize(std::min(all.size(), static_cast<std::size_t>(kept)));
    longer.clear();
    for (const Next& next : all) {
      Sum& sum = longer.emplace_back(sums[next.sum]);
      sum.squared = next.squared;
      sum.z[k] = next.z;
      sum.left.head(k) -= static_cast<double>(next.z) * reduced.R.col(k).head(k);
    }
    sums.swap(longer);
  }
  const bool is_nearer = sums[0].squared < from_plane.squaredNorm();
  return original_integers(reduced, is_nearer ? VectorXd(plane + sums[0].z.cast<double>()) : plane);
}

IntegerMatrix integer_kernel(IntegerMatrix A) {
  using Eigen::Index;
  IntegerMatrix all = IntegerMatrix::Identity(A.cols(), A.cols());
  const auto exchange = [&](Index i, Index j) {
    A.col(i).swap(A.col(j));
    all.col(i).swap(all.col(j));
  };
  // Throughout, A is the given matrix times `all`. In rows that are done, its columns from `rank` on are 0.
  Index rank = 0;
  for (Index row = 0; row < A.rows() && rank < A.cols(); ++row) {
    for (Index j = rank + 1; j < A.cols(); ++j) {
      while (A(row, j) != 0) {  // the entry falls
        const std::int64_t times = A(row, rank) / A(row, j);
        A.col(rank) -= times * A.col(j);
        all.col(rank) -= times * all.col(j);
        exchange(rank, j);
      }
    }
    if (A(row, rank) != 0) ++rank;
  }
  return all.rightCols(A.cols() - rank);
}

}  // namespace holomorph::linear
