// From the Gram matrices of a surface with boundary to its holomorphic basis, and to the period matrix of its double.
#pragma once

#include <Eigen/Core>

#include "conformal/projection.h"
#include "topology/homology.h"

namespace holomorph::conformal {

/// n = 2g + b - 1 = genus of the double. theta_i = h^N_i + i sum_j C#_ij h^D_j: real combinations of these are
/// holomorphic forms whose imaginary part vanishes along the boundary, so that each loop becomes a straight line.
struct BoundedBasis {
  ProjectedStar projected;
  Eigen::MatrixXcd coefficients;   ///< 2n x n: column i is theta_i, written in h^N_1 .. h^N_n, h^D_1 .. h^D_n
  Eigen::MatrixXcd period_matrix;  ///< n x n, Omega of the double; (i/2) Cap# on planar surfaces
  PeriodBounds bounds;             ///< of Im Omega of the polyhedral double
};

/// @param G_N,G_D n x n, of the natural and the Dirichlet forms: first those of the 2g handle classes, the same in both
/// families, then those of the b - 1 loops
/// @param W n x n, W_ij = int h^N_i ^ h^D_j
BoundedBasis bounded_basis(const Eigen::MatrixXd& G_N, const Eigen::MatrixXd& G_D, const topology::IntegerMatrix& W,
                           int genus);

}  // namespace holomorph::conformal
