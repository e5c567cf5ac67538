// The paper's averaged star (§ 7), for comparison only.
#pragma once

#include <span>
#include <vector>

#include "mesh/half_edges.h"

namespace holomorph::forms {

/// On each edge the mean over its two faces of the face-wise star. Not closed, so it has no well-defined integral.
/// @param form,result #E values along half-edge 2e
std::vector<double> averaged_star(const mesh::HalfEdges& half_edges, std::span<const double> lengths,
                                  const std::vector<double>& form);

}  // namespace holomorph::forms
