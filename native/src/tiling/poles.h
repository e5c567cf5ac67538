// A form with poles, in the bases of a landscape, and how even its density is.
#pragma once

#include <vector>

#include "tiling/landscape.h"

namespace holomorph::tiling {

/// theta_0 = sum_j c_j theta_j + sum_i r_i omega_i; its scale is free.
struct Poles {
  std::vector<int> vertices;
  Eigen::VectorXcd coefficients;  ///< c_j
  Eigen::VectorXcd residues;      ///< r_i; they sum to 0 on a closed surface
  double variance = 0;            ///< unevenness of |theta_0|^2, and what leverage adds
};

/// |theta_0|^2 on the samples.
Eigen::ArrayXd density(Landscape& landscape, const Poles& poles, Execution& execution);

/// The median; more than 0 even where the density falls below all numbers.
double median(const Eigen::ArrayXd& density);

/// Variance of log(q / median q + uv::kDensityFloor). Not of the mean: beside one high peak all else would be below the
/// floor, and so even, and a pole more, which fills a part of it, a loss.
double unevenness(const Eigen::ArrayXd& density);

/// 95 % over 5 % quantile.
double density_ratio(const Eigen::ArrayXd& density);

/// That, or half of the median over the 1 % quantile where it is larger: toes and horns have little area, and are seen
/// all the same where one square covers them.
double spread(const Eigen::ArrayXd& density);

}  // namespace holomorph::tiling
