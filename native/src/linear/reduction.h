// Lattices: reduction by LLL, points near a target, and the integer kernel of a matrix.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace holomorph::linear {

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic>;
using IntegerVector = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>;

/// A basis of the lattice B Z^n whose columns are short and nearly orthogonal.
struct ReducedBasis {
  Eigen::MatrixXd basis;    ///< m x n: B * transform, rounded once
  IntegerMatrix transform;  ///< n x n, its determinant 1 or -1
  Eigen::MatrixXd Q;        ///< m x n: basis = Q R, Q^T Q = 1
  Eigen::MatrixXd R;        ///< n x n: upper triangular, its diagonal positive
  std::int64_t steps = 0;   ///< columns that were compared with the one before
  int blocks = 1;           ///< that were reduced one by one; 1: the whole
};

inline constexpr double kDelta = 0.99;  ///< of Lovasz's condition, by default

/// LLL reduction in floating-point arithmetic (Schnorr & Euchner 1994, doi:10.1007/BF01581144): |R_jk| <= R_jj / 2 for
/// j < k, and delta R_k-1,k-1^2 <= R_k-1,k^2 + R_kk^2 (Lovasz's condition). Both hold to rounding: the first to some m
/// epsilon |column k|, and 1e-9 R_jj.
/// @param B m x n, its columns linearly independent; they may differ in length by many orders of magnitude
/// @param delta in (1/4, 1)
/// @throw SolverError a column is not finite, or depends linearly on the others to rounding: it is as near to their
/// span as 4 n epsilon of its length
/// @throw SolverError the transform has integers beyond 2^53, where doubles are no longer exact
/// @param tick called for each step, O(m n); it may throw
/// Cost: O(m n^2), and besides O(m n) for each exchange of two columns.
ReducedBasis reduce(const Eigen::MatrixXd& B, double delta = kDelta, const std::function<void()>& tick = {});

/// Finds integers z such that B z is near the target: Q^T (target - B z) is within the box |y_j| <= R_jj / 2. So the
/// square |target - B z|^2 is at most the sum of R_jj^2 / 4, besides the target's squared distance from the span of B.
/// @param target m @return n integers, for the B that was reduced
/// @throw SolverError the target is not finite @throw SolverError the integers are beyond 2^53
IntegerVector nearest_plane(const ReducedBasis& reduced, const Eigen::VectorXd& target);

/// The same, or integers with a smaller |target - B z|: the least of those to which the `kept` least partial sums lead,
/// from the last coefficient to the first. Cost: so many times as much. @param kept from 1
IntegerVector nearest_of_planes(const ReducedBasis& reduced, const Eigen::VectorXd& target, int kept);

struct NearPoints {
  std::vector<IntegerVector> integers;  ///< for the B that was reduced, in a fixed order
  std::int64_t steps = 0;               ///< nodes of the search
  bool is_complete = true;              ///< false where `most_steps` ended the search
};

/// Finds all z with |target - B z|^2 <= squared_radius (Fincke & Pohst 1985, doi:10.1090/S0025-5718-1985-0777278-8).
/// The caller allows for rounding: some 1e-13 |target|^2.
/// @param target m @param tick called every few thousand nodes; it may throw
/// @throw SolverError the integers are beyond 2^53
/// Cost: grows with the number of lattice points in the balls of all projections of the lattice.
NearPoints near_points(const ReducedBasis& reduced, const Eigen::VectorXd& target, double squared_radius,
                       std::int64_t most_steps, const std::function<void()>& tick = {});

/// Returns a basis of {z in Z^n : A z = 0}, n x k, by exchanges and differences of columns (Euclid's algorithm in each
/// row).
/// Cost: O(m n^2) for small entries. It suits only these: entries may grow on the way.
IntegerMatrix integer_kernel(IntegerMatrix A);

}  // namespace holomorph::linear
