// The combination of holomorphic forms that is shown first.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "uv/density_objective.h"

namespace holomorph::uv {

/// Returns e_x + i e_y of the plane of each triangle, 3 x #triangles, x along side 0. The form A dz is the field A (e_x
/// + i e_y), gradient of u plus i times gradient of v. @pre the surface has positions
Eigen::MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles);

/// Finds coefficients c, g numbers, for which the texture density |theta|^2 of theta = sum_j c_j theta_j is most even.
/// They have the least variance over the surface's area of log(|theta|^2 / mean + 1e-4), plus a small term against
/// distortion (balance.cpp); the scale is free. The minimum is local, the best from several starts that are fixed in
/// space; the same input gives the same bits.
/// @param samples not used where g = 1
/// @param basis #forms x g, the theta_j in the forms
/// @param kind real on bounded surfaces, so that boundaries remain straight
Eigen::VectorXcd balanced_coefficients(const mesh::Surface& surface, const FormSamples& samples,
                                       const Eigen::MatrixXcd& basis, Coefficients kind, Execution& execution);

/// Searches for them on the samples alone, without the shortcut for one form and the choice of the phase. The result
/// depends on the space of the forms, not on their basis. Among the ends of the descents it prefers a map that is even
/// (95 % over 5 % quantile of the density), little sheared and not flipped.
/// @param triangles where the samples are
Eigen::VectorXcd lowest_variance(const mesh::Surface& surface, const std::vector<int>& triangles,
                                 const SampledParts& parts, Coefficients kind, Execution& execution);

}  // namespace holomorph::uv
