// The lattice vectors closest to a target, by enumeration around Babai's point.
#pragma once

#include <vector>

#include "tiling/lattice.h"

namespace holomorph::tiling {

struct LatticeVector {
  IntegerVector integers;      ///< n: the vector is B * integers
  double squared_distance = 0; ///< |target - B * integers|^2
};

struct ClosestVectors {
  std::vector<LatticeVector> vectors;  ///< distinct, ascending by distance; Babai's point alone is always found
  bool proven = false;  ///< every other vector of the lattice is at least as far away, to rounding
};

/// The `count` closest vectors that are found within `most_nodes` nodes of the tree of Schnorr & Euchner (1994,
/// doi:10.1007/BF01581144): coefficients are chosen from the last to the first, each from the nearest value outwards.
/// Nodes are taken by the distance that is expected of their best vector, not depth first: where the tree is too large,
/// as it is beyond some 40 dimensions, this tries the choices that were nearly even first (as the sampling of Lindner &
/// Peikert 2011, doi:10.1007/978-3-642-19074-2_21, does).
/// @param target m @param count,most_nodes at least 1
/// @throw Error the integers are beyond 2^53
/// Cost: O(n^2) for each node at most; memory O(most_nodes + count n).
ClosestVectors closest_vectors(const ReducedBasis& reduced, const Eigen::VectorXd& target, int count, int most_nodes);

}  // namespace holomorph::tiling
