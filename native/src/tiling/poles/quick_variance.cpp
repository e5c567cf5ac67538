#include "tiling/poles/quick_variance.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "uv/minimise.h"

namespace holomorph::tiling {
namespace {

using Eigen::ArrayXf;
using Eigen::MatrixXf;
using Eigen::VectorXf;

// Near a zero of the form the logarithm is too curved for its derivative to be of use. There densities count as this
// part of their geometric mean.
constexpr float kBent = 0.1F;
constexpr double kDamping = 0.01;                      // of the mean curvature
constexpr double kProgress = 1e-5, kShortest = 0.001;  // smaller progress and shorter steps are rounding

ArrayXf squares(const VectorXf& A) {
  const Index count = A.size() / 2;
  return A.head(count).array().square() + A.tail(count).array().square();
}

}  // namespace

QuickVariance::QuickVariance(const Eigen::MatrixXcf& parts, uv::Coefficients kind)
    : M_(2 * parts.rows(), (kind == uv::Coefficients::real ? 1 : 2) * parts.cols()) {
  M_.leftCols(parts.cols()) << parts.real(), parts.imag();
  if (kind == uv::Coefficients::complex) M_.rightCols(parts.cols()) << -parts.imag(), parts.real();
}

double QuickVariance::operator()(const VectorXd& x, VectorXd& gradient) const {
  VectorXf A = M_ * x.cast<float>();
  const Index count = A.size() / 2;
  const ArrayXf q = squares(A);
  const float mean = q.mean();
  ArrayXf deviation = (q / mean + floor_).log();
  deviation -= deviation.mean();
  const ArrayXf inverse = 1 / (q + floor_ * mean);
  // The mean depends on all unknowns: this is its part, the same for all samples.
  const float through_mean = -2 * (deviation * q * inverse).mean() / mean;
  const ArrayXf by_q = (2 * deviation * inverse + through_mean) * (2 / static_cast<float>(count));
  A.head(count).array() *= by_q;
  A.tail(count).array() *= by_q;
  gradient = (M_.transpose() * A).cast<double>();
  return deviation.square().mean();
}

void QuickVariance::descend(VectorXd& x, int most_steps, const std::function<void()>& tick) const {
  uv::minimise(
      [&](const VectorXd& at, VectorXd& gradient) {
        tick();
        return (*this)(at, gradient);
      },
      x, {.most_steps = most_steps, .progress = kProgress, .shortest = kShortest}, inverse_curvature(x));
  x.normalize();
}

ArrayXd QuickVariance::density(const VectorXd& x) const { return squares(M_ * x.cast<float>()).cast<double>(); }

// The inverse Hessian of Gauss and Newton: it has first derivatives of the logarithms alone.
MatrixXd QuickVariance::inverse_curvature(const VectorXd& x) const {
  const VectorXf A = M_ * x.cast<float>();
  const Index count = A.size() / 2;
  const ArrayXf q = squares(A);
  const float mean = q.mean(), middle = mean * std::exp((q / mean + floor_).log().mean());
  const ArrayXf inverse = 2 / (q + kBent * middle);
  MatrixXf J = (inverse * A.head(count).array()).matrix().asDiagonal() * M_.topRows(count);
  J += (inverse * A.tail(count).array()).matrix().asDiagonal() * M_.bottomRows(count);
  J.rowwise() -= J.colwise().mean().eval();
  MatrixXf H = MatrixXf::Zero(J.cols(), J.cols());
  H.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose(), 2 / static_cast<float>(count));
  MatrixXd C = H.cast<double>();
  C.diagonal().array() += kDamping * C.diagonal().mean() + std::numeric_limits<double>::min();
  return C.llt().solve(MatrixXd::Identity(C.rows(), C.cols()));
}

}  // namespace holomorph::tiling
