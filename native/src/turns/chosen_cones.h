// Cones that are chosen, and what is then missing of the holes.
#pragma once

#include <vector>

#include "base/execution.h"
#include "turns/net.h"

namespace holomorph::turns {

/// The chosen cones, and k-th turns at the holes with which the integral of u^2 is least, see scale_form.h: together
/// they are k times the Euler characteristic of the surface with its holes filled.
/// @param chosen #V, k-th turns that are missing, none on the boundary
/// @return #V as in Cones. @throws TopologyError for other sums on a surface without holes, SolverError, Cancelled
std::vector<int> with_holes(const Net& net, int k, const std::vector<int>& chosen, Execution& execution);

}  // namespace holomorph::turns
