// The integer classes of a surface with their energies: what is left of it by Torelli's theorem.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "linear/reduction.h"
#include "topology/homology.h"

namespace holomorph::moduli {

/// Logarithms of the least and the greatest ratio x A x^T / x B x^T.
struct LogRatios {
  double least, greatest;
};

/// Compares two forms by their generalised eigenvalues. @pre symmetric. Where A is not positive definite, the least is
/// -infinity.
/// @throws SolverError where B is not positive definite
LogRatios log_ratios(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

using linear::IntegerMatrix;

/// The lattice Z^n of integer classes, its quadratic form the energy of their harmonic forms, which is known between
/// two bounds, and an antisymmetric integer pairing. Two closed surfaces of genus >= 1 are conformally equivalent if
/// and only if their lattices are isometric by integers that keep the wedge product, n = 2g (Torelli). With boundary
/// the lattice belongs to the Dirichlet forms, n = 2g + b - 1; int h^D_i ^ h^D_j tells a surface from its mirror image.
struct PeriodLattice {
  Eigen::MatrixXd lower, upper;  ///< n x n: lower <= energy <= upper, as quadratic forms
  Eigen::MatrixXd projected;     ///< n x n: the value between them
  IntegerMatrix pairing;         ///< n x n
};

/// The lattice of a closed surface. @param G not below the exact Gram matrix of classes with the wedge matrix W @throws
/// SolverError
PeriodLattice closed_lattice(const Eigen::MatrixXd& G, const topology::IntegerMatrix& W);

/// The lattice of a surface with boundary. @param G_N,G_D likewise of the natural and the Dirichlet forms
/// @param W n x n, W_ij = int h^N_i ^ h^D_j: [[J_h, 0], [X, 1]]. @throws SolverError
PeriodLattice bounded_lattice(const Eigen::MatrixXd& G_N, const Eigen::MatrixXd& G_D, const topology::IntegerMatrix& W,
                              int genus);

/// Rows: an LLL-reduced basis of Z^n with a quadratic form, ascending by length. @throws SolverError
/// @param tick called for each step of the reduction; it may throw, here and below
IntegerMatrix short_basis(const Eigen::MatrixXd& form, const std::function<void()>& tick = {});

/// The same lattice in a basis of short vectors, ascending by length.
struct ReducedLattice {
  PeriodLattice lattice;
  IntegerMatrix basis, inverse;  ///< rows: the short vectors in the old basis, and the other way round
};

/// @throws SolverError, Error where integers leave 2^53
ReducedLattice reduced(const PeriodLattice& lattice, const std::function<void()>& tick = {});

/// A B. @throws Error where an entry leaves 2^53
IntegerMatrix checked_product(const IntegerMatrix& A, const IntegerMatrix& B);

/// Returns the lattice whose bounds are the projected energies, as if these were exact.
PeriodLattice projected_lattice(const PeriodLattice& lattice);

/// Returns the half-width of the bounds, in the metric of equivalence.h: log of the largest ratio of `upper` and
/// `projected`.
double radius(const PeriodLattice& lattice);

}  // namespace holomorph::moduli
