// The order of the unknowns. Multigrid is several times as fast if neighbours are near each other in memory.
#pragma once

#include <vector>

#include "base/execution.h"
#include "solver/laplacian.h"

namespace holomorph::solver {

/// Whether vertices with consecutive numbers have neighbours that are far apart: most entries of the rows are far from
/// every entry of the row before. False if all blocks of unknowns fit into a processor's cache anyway.
/// Cost: one pass over an eighth of the entries.
bool is_scattered(const Laplacian& L);

/// Returns all vertices, breadth first from vertex 0 (and from the next one that is left, where L is not connected).
/// @throws Cancelled
std::vector<int> breadth_first_order(const Laplacian& L, Execution& execution);

/// Returns the same symmetric matrix in another order. @param order the old number of each new one, a permutation
Laplacian renumbered(const Laplacian& L, const std::vector<int>& order);

}  // namespace holomorph::solver
