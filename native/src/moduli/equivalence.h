// Whether two surfaces are conformally equivalent, as far as the bounds of their periods tell (paper § 9).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "linear/reduction.h"
#include "topology/homology.h"

namespace holomorph::moduli {

// The integer classes of a surface with their energies: what is left of it by Torelli's theorem.

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

/// R with R pairing_a R^T = sign pairing_b, |det R| = 1: row i is class i of b written in the classes of a.
struct Isometry {
  IntegerMatrix matrix;
  /// max |log of the ratio of R E_a R^T and E_b|, E the projected energies: a metric. For tori it is the hyperbolic
  /// distance of tau. The energies of corresponding classes differ at most by the factor exp(residual).
  double residual = 0;
  /// The bounds overlap if and only if this is <= 0. Else a map between the surfaces in the homotopy class of R
  /// stretches some direction exp(excess) times as much as another, since a map changes energies at most by its
  /// dilatation.
  double excess = 0;
};

struct Isometries {
  std::vector<Isometry> found;
  bool is_complete = true;  ///< false where the limit of steps ended the search
};

/// Limit of one search: some seconds.
inline constexpr std::int64_t kMostSteps = 20'000'000;

/// What is searched for, and how long.
struct SearchOptions {
  int sign = 1;                     ///< 1 keeps the orientation, -1 reverses it
  double slack = 0;                 ///< finds all R with excess <= slack, and 1e-9 more for rounding
  std::int64_t steps = kMostSteps;  ///< most steps of the search
};

/// Finds all R whose excess is at most `slack`. The search goes row by row, in a reduced basis of b from short to long.
/// Candidates are the lattice points near the one point that has the right energy products with the rows before. They
/// lie in the plane of points with the right wedge products. A candidate is dropped if the bounds exclude the block of
/// rows so far. Nothing that the bounds allow is ever dropped.
/// @throws SolverError, Cancelled, Error where integers leave 2^53
Isometries isometries(const PeriodLattice& a, const PeriodLattice& b, const SearchOptions& options,
                      Execution& execution);

enum class Verdict { indistinguishable, mirror_image, not_equivalent, undecided };

struct Comparison {
  Verdict verdict = Verdict::undecided;
  std::optional<Isometry> isometry;  ///< the nearest that was found; none where there is none
  int sign = 1;                      ///< -1: it reverses the orientation
  /// The exact periods are certainly no further apart than this, in the metric of the residual; else infinite.
  double tolerance = 0;
  /// Not equivalent: every map between the surfaces, and between one and the mirror image of the other, stretches some
  /// direction at least exp(margin) times as much as another, somewhere. Indistinguishable, mirror image: by how much
  /// the residual is below what was asked for. Undecided: 0.
  double margin = 0;
  bool is_complete = true;  ///< false where a limit of steps ended a search that had to be complete
};

/// Indistinguishable, or mirror image: an integer matrix brings the projected periods of one surface as near to those
/// of the other as `needed` or `allowed`. Not equivalent: the bounds exclude that the exact periods are within
/// `allowed` by any integer matrix, orientation kept or reversed. Undecided: neither.
/// @param allowed residual that counts as none
/// @param needed residual up to which periods with errors count as the same
/// @param steps limit of each search
/// @throws SolverError, Cancelled, Error where integers leave 2^53
Comparison compare(const PeriodLattice& a, const PeriodLattice& b, double allowed, double needed, std::int64_t steps,
                   Execution& execution);

}  // namespace holomorph::moduli
