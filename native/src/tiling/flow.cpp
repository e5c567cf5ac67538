#include "tiling/flow.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <complex>
#include <limits>

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double kNoLine = 1e-6;  // mean square of the cosine, below which it is rounding

std::optional<double> phase_along(const std::array<double, 3>& axis, const MatrixXcd& frames, const VectorXcd& A) {
  const Eigen::RowVector3cd direction = Eigen::RowVector3d(axis[0], axis[1], axis[2]).cast<Complex>();
  const Eigen::ArrayXcd along = (direction * frames).transpose().array() * A.array() /
                                A.array().abs().max(std::numeric_limits<double>::min()).cast<Complex>();
  const Complex line = along.square().mean();  // as a line, without a sense
  if (std::abs(line) <= kNoLine * direction.squaredNorm()) return std::nullopt;
  const Complex turn = std::polar(1.0, -std::arg(line) / 2);
  return std::arg((turn * along.sum()).real() < 0 ? -turn : turn);
}

VectorXcd fitted_coefficients(const VectorXcd& wanted, const MatrixXcd& wanted_frames, const MatrixXcd& forms,
                              const VectorXcd& known, const MatrixXcd& frames, bool real) {
  MatrixXcd rows(3 * wanted.size(), forms.cols());
  VectorXcd right(3 * wanted.size());
  for (Index s = 0; s < wanted.size(); ++s) {
    const double weight = 1 / (std::abs(wanted[s]) + std::numeric_limits<double>::min());
    rows.middleRows(3 * s, 3) = weight * frames.col(s) * forms.row(s);
    right.segment(3 * s, 3) = weight * (wanted[s] * wanted_frames.col(s) - known[s] * frames.col(s));
  }
  const MatrixXcd gram = rows.adjoint() * rows;
  const VectorXcd moments = rows.adjoint() * right;
  if (real) return gram.real().ldlt().solve(moments.real()).cast<Complex>();
  return gram.ldlt().solve(moments);
}

}  // namespace holomorph::tiling
