// Splits islands that overlap themselves until none does.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::islands {

/// Numbers the parts, #F: polygons of a component with the same number are connected and do not overlap. A component
/// that does not overlap itself has one number. A part grows from a polygon by neighbours that overlap none of the
/// polygons before; the rest of the component begins anew.
/// @param surface its components are the islands. @param uv #C x 2
/// Cost: O(#T) for each number of a component.
std::vector<int> parted(const mesh::Surface& surface, const uv::UvArray& uv);

}  // namespace holomorph::islands
