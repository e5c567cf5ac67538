// Small dense algebra that is right with its rounding: bounds of invariants from a Gram matrix that is not below the
// exact one.
#pragma once

#include <Eigen/Core>

namespace holomorph::conformal {

/// Returns a symmetric matrix that is not below T G T^T, as quadratic forms, and above it by rounding alone.
/// @param G symmetric
Eigen::MatrixXd above_congruent(const Eigen::MatrixXd& T, const Eigen::MatrixXd& G);

/// Returns a matrix that is not above A^-1. For any symmetric X, A^-1 - (2 X - X A X) = (A^-1 - X) A (A^-1 - X) >= 0.
/// @pre A positive definite
Eigen::MatrixXd below_inverse(const Eigen::MatrixXd& A);

/// Bounds of the period matrix.
struct PeriodBounds {
  Eigen::MatrixXd lower, upper;            ///< lower <= Im Omega <= upper as quadratic forms
  Eigen::MatrixXd real_lower, real_upper;  ///< bounds of each entry of Re Omega
};

/// Bounds Omega from the Gram matrix G >= G_exact of admissible forms in a canonical basis:
///     (G_bb)^-1 <= Im Omega <= [1, -Z] G [1, -Z]^T for any Z, the least with Z = G_ab (G_bb)^-1,
/// and, with the lower bound J^T G^-1 J of G_exact, also Re Omega = -G_ab Im Omega.
PeriodBounds period_bounds(const Eigen::MatrixXd& G);

}  // namespace holomorph::conformal
