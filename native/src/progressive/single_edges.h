// Triangulations in which no two edges have the same ends.
#pragma once

#include <optional>

#include "mesh/surface.h"

namespace holomorph::progressive {

/// A diagonal of a polygon may join two vertices that another edge joins as well: the polygons are a valid mesh, their
/// triangles as a mesh of their own are none. Turns such diagonals inside the quadrilateral of their two triangles.
/// @return the surface with other triangles, their corners and edges (its lengths are no longer right), or nothing if
/// all is well as it is
/// @throws InvalidMesh for an intrinsic surface, and where turning helps nothing
std::optional<mesh::Surface> with_single_edges(const mesh::Surface& surface);

}  // namespace holomorph::progressive
