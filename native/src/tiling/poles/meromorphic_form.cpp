#include "tiling/poles/meromorphic_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/dense.h"

namespace holomorph::tiling {
namespace {

constexpr double kLeast = 1e-200;  // least median, relative to the largest density
constexpr double kNoLine = 1e-6;   // mean square of the cosine, below which it is rounding

double quantile(std::vector<double>& values, double q) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

VectorXcd samples_of(const MeromorphicForm& form, const GreensFunctions& greens) {
  return greens.basis().holomorphic().M * form.coefficients + greens.at(form.poles) * form.residues;
}

ArrayXd density(const MeromorphicForm& form, const GreensFunctions& greens) {
  return samples_of(form, greens).cwiseAbs2().array();
}

double median(const ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::max(*middle, kLeast * density.maxCoeff());
}

double unevenness(const ArrayXd& density) {
  const ArrayXd y = (density / median(density) + uv::kDensityFloor).log();
  return (y - y.mean()).square().mean();
}

double density_ratio(const ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  return quantile(values, 0.95) / quantile(values, 0.05);
}

double spread(const ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  return std::max(quantile(values, 0.95) / quantile(values, 0.05), quantile(values, 0.5) / quantile(values, 0.01) / 2);
}

std::optional<double> phase_along(const std::array<double, 3>& axis, const MatrixXcd& frames, const VectorXcd& A) {
  const Eigen::RowVector3cd direction = Eigen::RowVector3d(axis[0], axis[1], axis[2]).cast<Complex>();
  const Eigen::ArrayXcd along = (direction * frames).transpose().array() * A.array() /
                                A.array().abs().max(std::numeric_limits<double>::min()).cast<Complex>();
  const Complex line = along.square().mean();  // as a line, without a sense
  if (std::abs(line) <= kNoLine * direction.squaredNorm()) return std::nullopt;
  // Half the angle of the mean square is the direction of the line. Its sense is the one in which more of the surface
  // runs.
  const Complex turn = std::polar(1.0, -std::arg(line) / 2);
  return std::arg((turn * along.sum()).real() < 0 ? -turn : turn);
}

VectorXcd fitted_coefficients(const VectorXcd& wanted, const MatrixXcd& wanted_frames, const MatrixXcd& forms,
                              const VectorXcd& known, const MatrixXcd& frames, bool real) {
  MatrixXcd rows(3 * wanted.size(), forms.cols());
  VectorXcd right(3 * wanted.size());
  for (Index s = 0; s < wanted.size(); ++s) {
    // Relative errors: the field counts alike where it is strong and where it is weak.
    const double weight = 1 / (std::abs(wanted[s]) + std::numeric_limits<double>::min());
    rows.middleRows(3 * s, 3) = weight * frames.col(s) * forms.row(s);
    right.segment(3 * s, 3) = weight * (wanted[s] * wanted_frames.col(s) - known[s] * frames.col(s));
  }
  const MatrixXcd gram = rows.adjoint() * rows;
  const VectorXcd moments = rows.adjoint() * right;
  if (real) return linear::solve_symmetric(MatrixXd(gram.real()), VectorXd(moments.real())).cast<Complex>();
  return linear::solve_symmetric(gram, moments);
}

}  // namespace holomorph::tiling
