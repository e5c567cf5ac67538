// The checks of progressive meshes that come from elsewhere: arrays of a file, records.
#pragma once

#include <cstddef>
#include <vector>

#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

/// Makes the base from its triangles and the first positions. @throws InvalidMesh if it is not a valid mesh, has
/// isolated vertices, or is not oriented consistently
void set_base(ProgressiveMesh& mesh, const std::vector<Triple>& triangles, std::size_t vertex_count);

/// Checks counts, permutations, corners and every split. If it returns, the levels and the original are valid meshes.
/// @throws InvalidMesh naming what is wrong
void check(const ProgressiveMesh& mesh);

}  // namespace holomorph::progressive
