// Progressive meshes as bytes, and the checks of what is read.
#pragma once

#include <string_view>
#include <vector>

#include "progressive/progressive_mesh.h"

namespace holomorph::progressive {

/// Makes the base from its triangles and the first positions. @throws InvalidMesh if it is not a valid mesh, has
/// isolated vertices, or is not oriented consistently
void set_base(ProgressiveMesh& mesh, const std::vector<Triple>& triangles, std::size_t vertex_count);

/// Checks counts, permutations, corners and every split. If it returns, the levels and the original are valid meshes.
/// @throws InvalidMesh naming what is wrong
void check(const ProgressiveMesh& mesh);

std::vector<char> to_bytes(const ProgressiveMesh& mesh);

/// Every count, index and split is checked, and every split is made once.
/// @throws InvalidMesh with what is wrong
ProgressiveMesh from_bytes(std::string_view bytes);

}  // namespace holomorph::progressive
