// The Riemann map of a disk to the unit disk.
#pragma once

#include <Eigen/Core>

#include "structure/structure.h"

namespace holomorph::plane {

/// Computes z = exp(2 pi i (u + iv)), #V, of a disk with one pole of residue 1: 0 at the pole, |z| = 1 on the boundary,
/// nowhere larger.
/// @param function #V x 2, that of theta_0 (structure::UvForms). @pre such a structure
Eigen::VectorXcd disk_map(const structure::Structure& structure, const uv::UvArray& function, Workers& workers);

}  // namespace holomorph::plane
