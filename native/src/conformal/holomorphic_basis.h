// From the Gram matrix of a harmonic basis to the holomorphic basis and the period matrix (paper § 7, § 9).
#pragma once

#include <Eigen/Core>

#include "conformal/projection.h"
#include "topology/homology.h"

namespace holomorph::conformal {

/// Everything here is dense and small: 2g x 2g. Index order of the harmonic basis: dual to the homology basis zeta.
///
/// The paper conjugates by averaging the face-wise star over the faces of an edge, which is not closed and tears. Here
/// *h_i = sum_j C_ij h_j is found by the pairing (Gu & Yau 2003, doi:10.2312/SGP/SGP03/127-137): C = G J in the
/// canonical basis. On a mesh C^2 = -1 holds only up to O(h^2), so C is projected, C# = C (-C^2)^(-1/2): then C#^2 =
/// -1, Omega is symmetric, Im Omega > 0, and nothing depends on the basis.
struct HolomorphicBasis {
  Eigen::MatrixXcd periods;        ///< 2g x g: int_{zeta_k} theta_j, so theta_j = sum_k periods(k, j) h_k
  Eigen::MatrixXcd period_matrix;  ///< Omega, g x g
  Eigen::MatrixXd lower, upper;    ///< guaranteed bounds of Im Omega of the polyhedral surface, as quadratic forms
};

/// @param G Gram matrix of the harmonic basis dual to zeta
HolomorphicBasis holomorphic_basis(const Eigen::MatrixXd& G, const topology::CanonicalBasis& basis);

}  // namespace holomorph::conformal
