// The projected star of harmonic forms, with or without boundary, and small dense algebra that is right with its
// rounding: bounds of invariants from a Gram matrix that is not below the exact one.
#pragma once

#include <Eigen/Core>

#include "base/execution.h"

namespace holomorph::forms {

/// Computes the geometric mean A # B = A^(1/2) (A^(-1/2) B A^(-1/2))^(1/2) A^(1/2) of positive definite matrices, by
/// Cholesky and one symmetric eigenproblem. The mean is invariant under congruence, so any root of A will do.
/// @throws SolverError if a matrix is not positive definite, or too badly conditioned
Eigen::MatrixXd geometric_mean(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A^-1, symmetric. @pre positive definite
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
/// (A + A^T) / 2
Eigen::MatrixXd symmetric(const Eigen::MatrixXd& A);

/// Two families of n harmonic forms that the star exchanges: *h^N_i = sum_j C_ij h^D_j and *h^D_j = sum_i D_ji h^N_i.
/// The pairing W_ij = int h^N_i ^ h^D_j gives C = G_N W^-T and D = -G_D W^-1 (Gu & Yau 2003,
/// doi:10.2312/SGP/SGP03/127-137). They are conjugate, C D = -1, if and only if G_N = W G_D^-1 W^T. On a mesh
///     W G_D^-1 W^T <= G_exact <= G_N
/// as quadratic forms, because both G are Dirichlet energies of admissible functions. G_N is replaced by the geometric
/// mean of the two sides, the polar projection of the star of the double. On a closed surface both families are the
/// same, W is the wedge matrix, and this is the polar projection of C onto C^2 = -1.
struct ProjectedStar {
  Eigen::MatrixXd natural_gram;    ///< G_N# = G_N # (W G_D^-1 W^T)
  Eigen::MatrixXd dirichlet_gram;  ///< G_D# = W^T (G_N#)^-1 W
  Eigen::MatrixXd star;            ///< C# = G_N# W^-T; D# = -G_D# W^-1 = -(C#)^-1
  Eigen::MatrixXd lower;           ///< W G_D^-1 W^T, the lower bound of G_N; the upper one is G_N itself
};

/// @param G_N,G_D n x n Gram matrices. @param W n x n, |det| 1, entries integers. @throws SolverError
ProjectedStar projected_star(const Eigen::MatrixXd& G_N, const Eigen::MatrixXd& G_D, const Eigen::MatrixXd& W);

/// Omega of a closed surface of genus g from the projected Gram matrix of a canonical basis alpha_1 .. beta_g, 2g x 2g:
/// Im Omega = (G_bb)^-1, Re Omega = -G_ab (G_bb)^-1.
Eigen::MatrixXcd period_matrix(const Eigen::MatrixXd& G);

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
PeriodBounds period_bounds(const Eigen::MatrixXd& G, Execution& execution);

}  // namespace holomorph::forms
