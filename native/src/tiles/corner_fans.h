// The smooth parts of a surface around each vertex.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::tiles {

/// (3 #T) For corner i of triangle t, at 3 t + i, the lowest corner of those at its vertex that edges which are not
/// sharp join it to.
/// @param is_sharp #E
std::vector<int> corner_fans(const mesh::Surface& surface, const std::vector<char>& is_sharp);

}  // namespace holomorph::tiles
