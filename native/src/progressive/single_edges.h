// Triangulations in which no two edges have the same ends.
#pragma once

#include <optional>

#include "mesh/surface.h"

namespace holomorph::progressive {

/// A diagonal of a polygon may join two vertices that another edge joins as well. Then the polygons are a valid mesh,
/// but their triangles are not. Flips such diagonals inside the quadrilateral of their two triangles.
/// @return the surface with other triangles, their corners and edges (its lengths are not updated); nothing if no two
/// edges have the same ends
/// @throws InvalidMesh for an intrinsic surface, and where a flip gives another double edge
std::optional<mesh::Surface> with_single_edges(const mesh::Surface& surface);

}  // namespace holomorph::progressive
