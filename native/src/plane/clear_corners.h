// The four corners of a disk whose border is a rectangle to the eye.
#pragma once

#include <optional>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::plane {

/// The four corners of a disk, or nothing where they are not clear. They follow the boundary, the surface on its left,
/// from the lowest vertex on.
///
/// They are clear where the boundary turns by more than 45 degrees at exactly four places, and back at none. What a
/// vertex turns by is its exterior angle. Where these are rough or the corners round, directions are averaged over a
/// part of the boundary's length. The turn at a place is that between the averages before and behind it. Parts from
/// 1/256 to 1/16 are tried, and the first that shows four is taken. Then each corner has to turn by 60 degrees. Last
/// comes terrain, whose heights make exterior angles meaningless. The same is done with the boundary's projection to
/// its least-squares plane, where the surface itself turns there, too. (A tray's rim is a rectangle, but its walls
/// meet.)
///
/// No length scale enters: 512-gons, stadiums, hexagons and L shapes have none.
std::optional<std::vector<int>> clear_corners(const mesh::Surface& surface, Execution& execution);

}  // namespace holomorph::plane
