// All points of a lattice in a ball (Fincke & Pohst 1985, doi:10.1090/S0025-5718-1985-0777278-8).
#pragma once

#include <functional>
#include <vector>

#include "lattice/reduction.h"

namespace holomorph::lattice {

struct NearPoints {
  std::vector<IntegerVector> integers;  ///< for the B that was reduced, in a fixed order
  std::int64_t steps = 0;               ///< nodes of the search
  bool is_complete = true;              ///< false where `most_steps` ended the search
};

/// Finds all z with |target - B z|^2 <= squared_radius. The caller allows for rounding: some 1e-13 |target|^2.
/// @param target m @param tick called every few thousand nodes; it may throw
/// @throw SolverError the integers are beyond 2^53
/// Cost: grows with the number of lattice points in the balls of all projections of the lattice.
NearPoints near_points(const ReducedBasis& reduced, const Eigen::VectorXd& target, double squared_radius,
                       std::int64_t most_steps, const std::function<void()>& tick = {});

}  // namespace holomorph::lattice
