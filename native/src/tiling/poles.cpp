#include "tiling/poles.h"

#include <algorithm>

namespace holomorph::tiling {
namespace {

constexpr double kLeast = 1e-200;  // relative

double quantile(std::vector<double>& values, double q) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

Eigen::ArrayXd density(Landscape& landscape, const Poles& poles, Execution& execution) {
  return (landscape.holomorphic().M * poles.coefficients + landscape.poles(poles.vertices, execution) * poles.residues)
      .cwiseAbs2()
      .array();
}

double median(const Eigen::ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::max(*middle, kLeast * density.maxCoeff());
}

double unevenness(const Eigen::ArrayXd& density) {
  const Eigen::ArrayXd y = (density / median(density) + uv::kDensityFloor).log();
  return (y - y.mean()).square().mean();
}

double density_ratio(const Eigen::ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  return quantile(values, 0.95) / quantile(values, 0.05);
}

double spread(const Eigen::ArrayXd& density) {
  std::vector<double> values(density.begin(), density.end());
  return std::max(quantile(values, 0.95) / quantile(values, 0.05), quantile(values, 0.5) / quantile(values, 0.01) / 2);
}

}  // namespace holomorph::tiling
