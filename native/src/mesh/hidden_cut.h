// Where a surface can be cut open so that hardly anyone sees it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

struct HiddenCut {
  std::vector<char> is_cut;  ///< #E
  double seen = 0;           ///< its length, each edge times its exposure, over the square root of the area
};

/// Joins the tips of a surface, four vertices far from each other, one after the other by the path that is seen least:
/// edges are as long as they are, times their exposure and a little more.
/// @param up of length 1, see AmbientOcclusion. @pre the surface has positions and is connected
/// Cost: rays from all vertices
HiddenCut hidden_cut(const Surface& surface, const std::optional<std::array<double, 3>>& up, Execution& execution);

}  // namespace holomorph::mesh
