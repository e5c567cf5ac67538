#include "tiling/rounding/rounding_metric.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "linear/dense.h"

namespace holomorph::tiling {
namespace {

constexpr double kChange = 0.2;     // relative change of the form that costs 1
constexpr double kRegular = 1e-12;  // of the largest diagonal entry, added to keep a Gram matrix definite
constexpr Index kManyColumns = 192, kColumns = 32;  // matrices with many columns are multiplied in blocks of columns

// Upper R with R^H R = H.
MatrixXcd root(MatrixXcd H) {
  if (H.rows() == 0) return H;
  H += kRegular * H.diagonal().real().maxCoeff() * MatrixXcd::Identity(H.rows(), H.cols());
  return linear::Cholesky(H).upper();
}

// Calls task(begin, size) for blocks of columns, in parallel.
template <class Task>
void for_columns(Index count, Execution& execution, const Task& task) {
  const auto blocks = static_cast<int>((count + kColumns - 1) / kColumns);
  constexpr int kAtATime = 8;
  for (int first = 0; first < blocks; first += kAtATime) {
    execution.report(0);
    run_long_tasks(execution.workers(), std::min(kAtATime, blocks - first), [&](int i) {
      const Index begin = (first + i) * kColumns;
      task(begin, std::min(kColumns, count - begin));
    });
  }
}

// Computes forms^H weights forms; for many columns only the lower half, which the Cholesky factorisation reads.
MatrixXcd gram(const MatrixXcd& forms, const VectorXcd& weights, Execution& execution) {
  const Index count = forms.cols();
  if (count < kManyColumns) return forms.adjoint() * weights.asDiagonal() * forms;
  MatrixXcd H = MatrixXcd::Zero(count, count);
  for_columns(count, execution, [&](Index begin, Index size) {
    const MatrixXcd weighted = weights.asDiagonal() * forms.middleCols(begin, size);
    H.block(begin, begin, count - begin, size).noalias() = forms.rightCols(count - begin).adjoint() * weighted;
  });
  return H;
}

}  // namespace

constexpr double kSame = 1e-9;  // relative distance up to which points count as the same

Eigen::Vector2d TextureLattice::coordinates(Complex z) const {
  Eigen::Matrix2d A;
  A << a.real(), b.real(), a.imag(), b.imag();
  return A.inverse() * Eigen::Vector2d(z.real(), z.imag());
}

Complex TextureLattice::nearest(Complex z) const {
  const Eigen::Vector2d c = coordinates(z);
  return point(std::round(c[0]), std::round(c[1]));
}

bool TextureLattice::has(Complex z) const { return std::abs(z - nearest(z)) < kSame * std::abs(z); }

double TextureLattice::symmetry() const {
  for (const int part : {3, 2}) {
    const Complex turn = std::polar(1.0, std::numbers::pi / part);
    if (has(turn * a) && has(turn * b)) return std::numbers::pi / part;
  }
  return std::numbers::pi;
}

VectorXcd mean_weights(const ArrayXd& density) {
  const ArrayXd floored = density + uv::kDensityFloor * density.mean();
  return (1 / (floored * static_cast<double>(density.size()))).matrix().cast<Complex>();
}

MatrixXcd defect_metric(const MatrixXcd& defects, const ArrayXd& target_density, Execution& execution) {
  return root(gram(defects, mean_weights(target_density), execution));
}

RoundingMetric::RoundingMetric(const RoundingProblem& problem, Execution& execution)
    : problem_(problem),
      of_change_(root(gram(problem.forms, mean_weights(problem.target_density), execution)) / kChange) {}

MatrixXcd RoundingMetric::rows(double defect) const {
  const Index all = problem_.forms.cols(), l = problem_.defects.cols();
  MatrixXcd rows = MatrixXcd::Zero(all + l, all);
  rows.topRows(all) = of_change_;
  if (l == 0) return rows;
  const MatrixXcd& metric = problem_.defect_metric;
  // Defects as a Gaussian: those of size `defect` cost 1, and those that moving poles repairs are as likely. The
  // inverse covariance is the metric.
  MatrixXcd covariance = defect * defect * linear::inverse(MatrixXcd(metric.adjoint() * metric));
  if (problem_.repairable.size() > 0) covariance += problem_.repairable;
  rows.bottomRightCorner(l, l) = root(linear::inverse(covariance));
  return rows;
}

MatrixXcd product(const MatrixXcd& A, const MatrixXcd& B, Execution& execution) {
  if (B.cols() < kManyColumns) return A * B;
  MatrixXcd result(A.rows(), B.cols());
  for_columns(B.cols(), execution, [&](Index begin, Index size) {
    result.middleCols(begin, size).noalias() = A * B.middleCols(begin, size);
  });
  return result;
}

}  // namespace holomorph::tiling
