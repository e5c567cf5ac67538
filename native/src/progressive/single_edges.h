// Triangulations in which no two edges have the same ends.
#pragma once

#include <optional>

#include "mesh/surface.h"

namespace holomorph::progressive {

/// Flips diagonals that have the same ends as another edge, inside the quadrilateral of their two triangles. With such
/// diagonals the polygons are a valid mesh, but their triangles are not.
/// @return the surface with other triangles, their corners and edges (its lengths are not updated); nothing if no two
/// edges have the same ends
/// @throws InvalidMesh for an intrinsic surface, and where a flip gives another double edge
std::optional<mesh::Surface> with_single_edges(const mesh::Surface& surface);

}  // namespace holomorph::progressive
