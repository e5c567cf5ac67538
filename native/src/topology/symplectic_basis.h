// Canonical bases, in exact integers.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace holomorph::topology {

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A B. Its cost is in proportion to the numbers of A other than 0.
/// @throws holomorph::Error if an entry leaves 64 bits
IntegerMatrix product(const IntegerMatrix& A, const IntegerMatrix& B);

/// Computes integer S with S W S^T = J = [[0, I], [-I, 0]], |det S| = 1, by symplectic Gram-Schmidt. Its rows are a
/// canonical basis.
/// @param W antisymmetric, |det| 1. @throws holomorph::Error if an entry leaves 64 bits
IntegerMatrix symplectic_basis(const IntegerMatrix& W);

struct CanonicalBasis {
  IntegerMatrix intersection;  ///< zeta_i . zeta_j = -W^-1
  IntegerMatrix cycles;        ///< R: rows a_1..a_g, b_1..b_g written in the zeta; R intersection R^T = J
  IntegerMatrix classes;       ///< S = R^-T: rows alpha_1..alpha_g, beta_1..beta_g written in the eta
};

CanonicalBasis canonical_basis(const IntegerMatrix& wedge);

}  // namespace holomorph::topology
