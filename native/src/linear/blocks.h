// Reduction of lattices of high rank, block by block: the segments of Koy and Schnorr (2001).
#pragma once

#include "base/task_progress.h"
#include "linear/reduction.h"

namespace holomorph::linear {

/// Columns of a block. Reducing it takes a fraction of a second.
inline constexpr int kBlock = 48;
inline constexpr int kMostRounds = 4;

/// LLL-reduces every block of neighbouring columns, projected orthogonally to the columns before it. Then it reduces
/// blocks that begin in the middle of these, and repeats both a few times. Nearest planes are found as after LLL,
/// though the R_jj fall more. Across blocks a column is exchanged only with near ones, and nothing is size-reduced.
/// @param B m x n, as for `reduce`
/// @param points m x p, to be rounded. Afterwards n x p: these and the basis, which is R, are in coordinates of the
/// span of B, and Q = 1
/// @throw as `reduce`; Cancelled
/// Cost: O(m n^2), and in each of at most `kMostRounds` rounds n / kBlock reductions of rank kBlock.
ReducedBasis reduce_by_blocks(const Eigen::MatrixXd& B, Eigen::MatrixXd& points, Execution& execution);

}  // namespace holomorph::linear
