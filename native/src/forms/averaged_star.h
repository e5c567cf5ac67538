// The paper's averaged star (§ 7), for comparison only.
#pragma once

#include <vector>

#include "mesh/intrinsic_triangulation.h"

namespace holomorph::forms {

/// Averages the face-wise star: on each edge the mean over its two faces, or the value on its one face. The result is
/// not closed, so it has no well-defined integral.
/// @param triangulation mollified: in a triangle without area there is no star
/// @param form,result #E values along half-edge 2e
std::vector<double> averaged_star(const mesh::IntrinsicTriangulation& triangulation, const std::vector<double>& form);

}  // namespace holomorph::forms
