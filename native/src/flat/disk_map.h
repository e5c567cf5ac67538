// Maps to the disk and to the sphere.
#pragma once

#include <Eigen/Core>

#include "structure/structure.h"

namespace holomorph::flat {

/// Computes z = exp(2 pi i (u + iv)), #V, of a disk with one pole of residue 1: 0 at the pole, |z| = 1 on the boundary,
/// nowhere larger.
/// @param function #V x 2, that of theta_0 (structure::PrimalForms). @pre such a structure
Eigen::VectorXcd disk_map(const structure::Structure& structure, const uv::UvArray& function, Workers& workers);

using PointArray = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// @throws TopologyError unless the surface is closed, of genus 0, with two poles
void require_sphere(const structure::Structure& structure);

/// Computes #V x 3 points of the unit sphere; keeps the orientation. z = exp(2 pi i (u + iv)) is 0 at the first pole,
/// of residue 1, and infinite at the second. z is scaled so that the mean height over the surface's area is 0. Then
/// inverse stereographic projection takes the poles to (0, 0, 1) and (0, 0, -1).
/// @param function #V x 2, that of theta_0 (structure::PrimalForms). @pre require_sphere
PointArray sphere_map(const structure::Structure& structure, const uv::UvArray& function, Workers& workers);

}  // namespace holomorph::flat
