// One-forms as vector fields in space: where a texture runs on a surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace holomorph::tiling {

/// The phase by which A dz is to be rotated so that u runs along the axis as far as it can, up or down alike where both
/// are as frequent. None where no phase does better than another, as on a plane to which the axis is normal.
std::optional<double> phase_along(const std::array<double, 3>& axis, const Eigen::MatrixXcd& frames,
                                  const Eigen::VectorXcd& A);

/// c for which sum_j c_j forms_j is nearest to the wanted field, relative to its size at each point.
/// @param wanted #samples in the frames of `wanted_frames`. @param forms,known #samples x n and #samples in `frames`
/// @param kind real: c is real
Eigen::VectorXcd fitted_coefficients(const Eigen::VectorXcd& wanted, const Eigen::MatrixXcd& wanted_frames,
                                     const Eigen::MatrixXcd& forms, const Eigen::VectorXcd& known,
                                     const Eigen::MatrixXcd& frames, bool real);

}  // namespace holomorph::tiling
