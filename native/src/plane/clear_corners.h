// The four corners of a disk whose border is a rectangle to the eye.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::plane {

/// Finds the four corners of a disk, or nothing where they are not clear. They follow the boundary, the surface on its
/// left, from the lowest vertex on.
///
/// They are clear where the boundary turns by more than 45 degrees at exactly four places, and back at none. The turn
/// at a vertex is its exterior angle. Where these are rough or the corners round, directions are averaged over a part
/// of the boundary's length. The turn at a place is then the mean direction after it less the mean direction before it.
/// Parts from 1/256 to 1/16 are tried, and the first that shows four corners is taken. Each corner has to turn by 60
/// degrees in that case. On terrain, heights make exterior angles meaningless. There the boundary's projection to its
/// least-squares plane is searched in the same way, and the surface itself has to turn at the corners, too. (The rim of
/// a tray is a rectangle, but a conformal map of the tray has no corners there.)
///
/// No length scale enters: 512-gons, stadiums, hexagons and L shapes have none.
std::optional<std::vector<int>> clear_corners(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::plane
