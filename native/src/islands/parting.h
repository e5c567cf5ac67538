// Islands that lie over themselves, parted until none does.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "uv/uv_map.h"

namespace holomorph::islands {

/// #F, a number for each polygon: those of a component that have the same one are connected and do not overlap. A
/// component that does not lie over itself has one number. From a polygon on, neighbours are added as long as they
/// overlap none of those before; what is left over begins anew.
/// @param surface its components are the islands. @param uv #C x 2
/// Cost: O(#T) for each number of a component.
std::vector<int> parted(const mesh::Surface& surface, const uv::UvArray& uv);

}  // namespace holomorph::islands
