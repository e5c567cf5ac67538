// From the Gram matrices of harmonic forms to the holomorphic basis and the period matrix (paper § 7, § 9).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/execution.h"
#include "forms/certain_bounds.h"
#include "topology/homology.h"

namespace holomorph::forms {

/// The star, the holomorphic basis and the period matrix. All matrices are dense and small.
///
/// The paper conjugates by averaging the face-wise star over the faces of an edge, which is not closed and tears. Here
/// *h_i = sum_j C_ij h_j is found by the pairing (Gu & Yau 2003, doi:10.2312/SGP/SGP03/127-137). C is projected so that
/// C#^2 = -1. Then Omega is symmetric, Im Omega > 0, and nothing depends on the basis.
struct HolomorphicBasis {
  ProjectedStar star;              ///< in the given basis; with one family G_D# belongs to its conjugates
  Eigen::MatrixXcd differentials;  ///< #forms x n: column j is theta_j, written in the harmonic forms
  Eigen::MatrixXcd period_matrix;  ///< Omega, n x n
  PeriodBounds bounds;             ///< guaranteed bounds of Omega of the polyhedral surface
};

/// The basis of a closed surface, n = g: theta_j has the period 1 over a_j and 0 over the other a.
/// @param G 2g x 2g, of the harmonic basis dual to zeta. @param W its wedge matrix
/// @param certain a matrix that is not below that of the surface, for the bounds: G, or G and its rounding
HolomorphicBasis closed_basis(const Eigen::MatrixXd& G, const Eigen::MatrixXd& certain,
                              const topology::IntegerMatrix& W, const topology::CanonicalBasis& canonical,
                              Execution& execution);

/// The basis of a surface with boundary, n = 2g + b - 1, the genus of the double.
/// theta_i = h^N_i + i sum_j C#_ij h^D_j. Real combinations of these are holomorphic forms whose imaginary part
/// vanishes along the boundary, so that each loop becomes a straight line. Omega is that of the double, (i/2) Cap# on
/// planar surfaces.
/// @param gram n x n each, G_N and G_D of the natural and the Dirichlet forms. The 2g handle classes come first, the
/// same in both families, then the b - 1 loops
/// @param certain as in closed_basis
/// @param W n x n, W_ij = int h^N_i ^ h^D_j
HolomorphicBasis bounded_basis(const std::vector<Eigen::MatrixXd>& gram, const std::vector<Eigen::MatrixXd>& certain,
                               const topology::IntegerMatrix& W, int genus, Execution& execution);

}  // namespace holomorph::forms
