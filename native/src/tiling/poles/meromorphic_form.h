// A form with poles, in a pole basis: how even its density is, and where it runs as a vector field in space.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tiling/greens/pole_basis.h"

namespace holomorph::tiling {

/// theta_0 = sum_j c_j theta_j + sum_i r_i omega_i; its scale is free.
struct MeromorphicForm {
  std::vector<int> poles;  ///< vertices
  VectorXcd coefficients;  ///< c_j
  VectorXcd residues;      ///< r_i; they sum to 0 on a closed surface
  double objective = 0;    ///< unevenness of |theta_0|^2, and what the Jacobian adds
};

/// Returns A of the form on the samples. @pre the Green's functions were solved for, here and below
VectorXcd samples_of(const MeromorphicForm& form, const GreensFunctions& greens);

/// |theta_0|^2 on the samples.
ArrayXd density(const MeromorphicForm& form, const GreensFunctions& greens);

/// Returns the median; more than 0 even where densities underflow.
double median(const ArrayXd& density);

/// Computes the variance of log(q / median q + uv::kDensityFloor). The mean in place of the median would not do. Beside
/// one high peak all else would be below the floor, and seem even. A pole that fills a part of it would seem a loss.
double unevenness(const ArrayXd& density);

/// Returns the 95 % over the 5 % quantile.
double density_ratio(const ArrayXd& density);

/// Returns the density ratio or, if it is larger, half of the median over the 1 % quantile. Toes and horns have little
/// area, but it is seen if one square covers them.
double spread(const ArrayXd& density);

/// Returns the phase that rotates A dz so that u runs along the axis as far as it can. The axis is first taken as a
/// line, then the more frequent of its two senses is chosen. None where no phase does better than another, as on a
/// plane to which the axis is normal.
std::optional<double> phase_along(const std::array<double, 3>& axis, const MatrixXcd& frames, const VectorXcd& A);

/// Returns the c for which sum_j c_j forms_j + known is nearest to the wanted field, relative to its size at each
/// point.
/// @param wanted #samples in the frames of `wanted_frames`. @param forms,known #samples x n and #samples in `frames`
/// @param real whether c is to be real
VectorXcd fitted_coefficients(const VectorXcd& wanted, const MatrixXcd& wanted_frames, const MatrixXcd& forms,
                              const VectorXcd& known, const MatrixXcd& frames, bool real);

}  // namespace holomorph::tiling
